-- id: STK-04
-- severity: error
-- title: An adjustable support is within its range
-- message: {subject}: it carries at {height_mm} mm over the plate, expected {least_mm} to {most_mm} mm
-- reference: the maker's range; stated by `design SUPPORT height_min_mm` and height_max_mm
WITH plate(top_mm) AS (SELECT max(max_z_mm) FROM instances WHERE role = 'base plate'),
carrying(instance, workpiece, height_mm) AS (
  SELECT c.instance, c.workpiece, max(c.z_mm) - plate.top_mm
  FROM workpiece_contacts AS c
  JOIN plate
  WHERE c.role = 'adjustable support'
  GROUP BY c.instance, c.workpiece)
SELECT c.instance || ' ' || c.workpiece AS subject,
       c.height_mm BETWEEN n.value AND x.value AS ok,
       'its range is not stated (`design ' || c.instance || ' height_min_mm MM reason TEXT`)'
         AS reason,
       c.height_mm,
       n.value AS least_mm,
       x.value AS most_mm
FROM carrying AS c
LEFT JOIN stated AS n ON n.subject = c.instance AND n.quantity = 'height_min_mm'
LEFT JOIN stated AS x ON x.subject = c.instance AND x.quantity = 'height_max_mm'
