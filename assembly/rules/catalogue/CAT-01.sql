-- id: CAT-01
-- severity: error
-- title: The numbers of an element agree with each other
-- message: {subject}: {faults}
-- reference: catalog/README.md, lint
-- each: elements.element
SELECT e.element AS subject,
       count(f.fault) = 0 AS ok,
       coalesce(group_concat(f.fault, '; '), 'sound') AS faults
FROM elements AS e
LEFT JOIN data_faults AS f ON f.element = e.element AND f.rule = 'CAT-01'
GROUP BY e.element
