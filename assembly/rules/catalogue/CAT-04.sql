-- id: CAT-04
-- severity: error
-- title: Facets tagged as holes belong to declared holes, and the other way round
-- message: {subject}: {faults}
-- reference: Peng et al. 2009, table 1
-- each: elements.element
SELECT e.element AS subject,
       count(f.fault) = 0 AS ok,
       coalesce(group_concat(f.fault, '; '), 'sound') AS faults
FROM elements AS e
LEFT JOIN data_faults AS f ON f.element = e.element AND f.rule = 'CAT-04'
GROUP BY e.element
