-- id: STK-03
-- severity: info
-- title: The tolerances of a stack add up to little
-- message: {subject}: {worst_mm} mm at worst ({likely_mm} mm by squares), expected {most_mm} mm
-- reference: sum, and root of the sum of squares; limit stack_tolerance_mm, stated by `design PIECE
--     height_tolerance_mm`
-- each: fits.shaft_instance
WITH pieces(screw, instance, tolerance_mm) AS (
  SELECT DISTINCT f.shaft_instance, i.instance, s.value
  FROM fits AS f
  JOIN instances AS i ON i.instance = f.hole_instance
  LEFT JOIN stated AS s ON s.subject = i.instance AND s.quantity = 'height_tolerance_mm'
  WHERE f.thread_formed = 0
    AND i.role IN ('riser', 'support'))
SELECT p.screw AS subject,
       CASE WHEN count(p.tolerance_mm) < count(*) THEN NULL
            ELSE sum(p.tolerance_mm) <= l.value END AS ok,
       'not stated: height_tolerance_mm of '
         || group_concat(CASE WHEN p.tolerance_mm IS NULL THEN p.instance END, ', ') AS reason,
       sum(p.tolerance_mm) AS worst_mm,
       sqrt(sum(p.tolerance_mm * p.tolerance_mm)) AS likely_mm,
       l.value AS most_mm,
       count(*) AS pieces
FROM pieces AS p
JOIN limits AS l ON l.name = 'stack_tolerance_mm'
GROUP BY p.screw
HAVING count(*) > 1
