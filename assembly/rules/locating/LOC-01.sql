-- id: LOC-01
-- severity: error
-- title: The workpiece stands on three points, against two, against one
-- message: {subject}: {first}, {second} and {third} points in its three main directions, and rank
--     {rank}
-- reference: The 3-2-1 principle; other arrangements (pins, vees) pass where they settle all six
--     freedoms
WITH groups(workpiece, points, place) AS (
  SELECT workpiece,
         count(*),
         row_number() OVER (PARTITION BY workpiece ORDER BY count(*) DESC)
  FROM locators
  GROUP BY workpiece, round(nx, 2), round(ny, 2), round(nz, 2)),
counts(workpiece, first, second, third) AS (
  SELECT workpiece,
         sum(points * (place = 1)),
         sum(points * (place = 2)),
         sum(points * (place = 3))
  FROM groups
  GROUP BY workpiece)
SELECT w.workpiece AS subject,
       w.rank = 6
         OR (coalesce(c.first, 0) >= 3 AND coalesce(c.second, 0) >= 2 AND coalesce(c.third, 0) >= 1)
         AS ok,
       coalesce(c.first, 0) AS first,
       coalesce(c.second, 0) AS second,
       coalesce(c.third, 0) AS third,
       w.rank
FROM workpieces AS w
LEFT JOIN counts AS c ON c.workpiece = w.workpiece
