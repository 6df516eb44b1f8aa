-- id: STK-01
-- severity: error
-- title: The supports are level
-- message: {subject}: its top is {off_mm} mm below the highest support that carries, expected
--     {allowed_mm} mm
-- reference: coplanar within 0.02 mm; limit level_mm
WITH carrying(workpiece, top_mm) AS (
  SELECT l.workpiece, max(l.z_mm) FROM locators AS l WHERE l.nz > 0.7 GROUP BY l.workpiece)
SELECT i.instance AS subject,
       abs(c.top_mm - i.max_z_mm) <= l.value AS ok,
       c.top_mm - i.max_z_mm AS off_mm,
       l.value AS allowed_mm
FROM instances AS i
JOIN carrying AS c
JOIN limits AS l ON l.name = 'level_mm'
WHERE i.role = 'support'
