-- id: CLP-04
-- severity: error
-- title: Friction holds the workpiece under its cutting loads
-- message: {subject}: {factor} times the load is the most that holds, expected {safety} times
-- reference: Wang 2000: friction cones and non-negative forces; limits friction and safety
SELECT c.load AS subject, c.holds AS ok, c.force_N, c.factor, l.value AS safety, c.unbalanced_N
FROM loads AS c
JOIN limits AS l ON l.name = 'safety'
