-- id: LOC-04
-- severity: warning
-- title: The locators are well conditioned
-- message: {subject}: condition {condition}, expected {largest} at most; spread the locators
-- reference: condition number of the locator matrix; limit condition
SELECT w.workpiece AS subject,
       CASE WHEN w.condition IS NULL THEN NULL ELSE w.condition <= l.value END AS ok,
       'the locators do not settle the workpiece' AS reason,
       w.condition,
       l.value AS largest
FROM workpieces AS w
JOIN limits AS l ON l.name = 'condition'
