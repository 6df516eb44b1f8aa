-- id: CAT-02
-- severity: error
-- title: The stored box encloses the element
-- message: {subject}: {faults}
-- reference: Peng et al. 2009, section 3.2: boxes that are too small hide collisions
-- each: elements.element
SELECT e.element AS subject,
       count(f.fault) = 0 AS ok,
       coalesce(group_concat(f.fault, '; '), 'sound') AS faults
FROM elements AS e
LEFT JOIN data_faults AS f ON f.element = e.element AND f.rule = 'CAT-02'
GROUP BY e.element
