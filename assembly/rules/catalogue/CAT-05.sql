-- id: CAT-05
-- severity: error
-- title: The unit is stated and the size is that of a fixture element
-- message: {subject}: {faults}
-- reference: catalog/README.md, lint
-- each: elements.element
SELECT e.element AS subject,
       count(f.fault) = 0 AS ok,
       coalesce(group_concat(f.fault, '; '), 'sound') AS faults
FROM elements AS e
LEFT JOIN data_faults AS f ON f.element = e.element AND f.rule = 'CAT-05'
GROUP BY e.element
