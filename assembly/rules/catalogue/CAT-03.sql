-- id: CAT-03
-- severity: error
-- title: The mesh is closed and outward
-- message: {subject}: {faults}
-- reference: catalog/README.md, lint: containment needs it
-- each: elements.element
SELECT e.element AS subject,
       count(f.fault) = 0 AS ok,
       coalesce(group_concat(f.fault, '; '), 'sound') AS faults
FROM elements AS e
LEFT JOIN data_faults AS f ON f.element = e.element AND f.rule = 'CAT-03'
GROUP BY e.element
