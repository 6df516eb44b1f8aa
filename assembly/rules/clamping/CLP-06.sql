-- id: CLP-06
-- severity: error
-- title: A clamp opens far enough and reaches the height of the workpiece
-- message: {subject}: opens {stroke_mm} mm, expected {needed_mm} mm; works at {height_mm} mm over the
--     plate, expected {least_mm} to {most_mm} mm
-- reference: opening for the workpiece's height tolerance and limit clamp_lift_mm; stated by
--     `design`: stroke_mm, height_min_mm, height_max_mm of the clamp, height_tolerance_mm of the
--     workpiece (0 where it is not)
WITH plate(top_mm) AS (SELECT max(max_z_mm) FROM instances WHERE role = 'base plate'),
work(instance, workpiece, height_mm, needed_mm, stroke_mm, least_mm, most_mm) AS (
  SELECT c.instance,
         c.workpiece,
         max(c.z_mm) - plate.top_mm,
         coalesce(t.value, 0) + l.value,
         s.value,
         n.value,
         x.value
  FROM clamps AS c
  JOIN plate
  JOIN limits AS l ON l.name = 'clamp_lift_mm'
  LEFT JOIN stated AS t ON t.subject = c.workpiece AND t.quantity = 'height_tolerance_mm'
  LEFT JOIN stated AS s ON s.subject = c.instance AND s.quantity = 'stroke_mm'
  LEFT JOIN stated AS n ON n.subject = c.instance AND n.quantity = 'height_min_mm'
  LEFT JOIN stated AS x ON x.subject = c.instance AND x.quantity = 'height_max_mm'
  GROUP BY c.instance, c.workpiece)
SELECT instance || ' ' || workpiece AS subject,
       stroke_mm >= needed_mm
         AND height_mm >= coalesce(least_mm, height_mm)
         AND height_mm <= coalesce(most_mm, height_mm) AS ok,
       'its stroke is not stated (`design ' || instance || ' stroke_mm MM reason TEXT`)' AS reason,
       stroke_mm,
       needed_mm,
       height_mm,
       least_mm,
       most_mm
FROM work
