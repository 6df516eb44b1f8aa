-- id: LOC-10
-- severity: warning
-- title: Two pins let the workpiece turn little and are far apart
-- message: {subject}: they leave {turn_deg} degrees, expected {most_deg} at most; {apart_mm} mm apart,
--     expected {least_mm} mm
-- reference: angle of both plays over twice their distance; limits pin_angle_deg and pin_spread
WITH pairs(subject, play_mm, apart_mm, diagonal_mm) AS (
  SELECT a.instance || ' ' || b.instance || ' ' || a.workpiece,
         a.play_mm + b.play_mm,
         sqrt(pow(a.x_mm - b.x_mm, 2) + pow(a.y_mm - b.y_mm, 2) + pow(a.z_mm - b.z_mm, 2)),
         sqrt(pow((i.max_x_mm - i.min_x_mm) * (1 - abs(a.dx)), 2)
              + pow((i.max_y_mm - i.min_y_mm) * (1 - abs(a.dy)), 2)
              + pow((i.max_z_mm - i.min_z_mm) * (1 - abs(a.dz)), 2))
  FROM pins AS a
  JOIN pins AS b ON b.workpiece = a.workpiece AND b.instance > a.instance
  JOIN instances AS i ON i.instance = a.workpiece)
SELECT p.subject,
       degrees(atan(p.play_mm / (2.0 * p.apart_mm))) <= g.value
         AND p.apart_mm >= s.value * p.diagonal_mm AS ok,
       degrees(atan(p.play_mm / (2.0 * p.apart_mm))) AS turn_deg,
       g.value AS most_deg,
       p.apart_mm,
       s.value * p.diagonal_mm AS least_mm,
       p.play_mm
FROM pairs AS p
JOIN limits AS g ON g.name = 'pin_angle_deg'
JOIN limits AS s ON s.name = 'pin_spread'
WHERE p.apart_mm > 0
