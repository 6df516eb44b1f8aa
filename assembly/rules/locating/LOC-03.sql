-- id: LOC-03
-- severity: warning
-- title: No locator is redundant
-- message: {subject}: {redundant} points add nothing ({names}); make them adjustable supports
-- reference: Asada and By 1985: more points than freedoms fight each other
SELECT workpiece AS subject,
       redundant = 0 AS ok,
       redundant,
       coalesce(redundant_names, 'none') AS names
FROM workpieces
WHERE points > 0
