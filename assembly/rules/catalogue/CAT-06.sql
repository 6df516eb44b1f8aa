-- id: CAT-06
-- severity: warning
-- title: Licence and source are stated
-- message: {subject}: {faults}
-- reference: catalog/README.md, lint
-- each: elements.element
SELECT e.element AS subject,
       count(f.fault) = 0 AS ok,
       coalesce(group_concat(f.fault, '; '), 'sound') AS faults
FROM elements AS e
LEFT JOIN data_faults AS f ON f.element = e.element AND f.rule = 'CAT-06'
GROUP BY e.element
