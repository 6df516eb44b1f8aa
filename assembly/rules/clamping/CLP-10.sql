-- id: CLP-10
-- severity: error
-- title: Clamps and locators stay clear of where a tool works
-- message: {subject}: {distance_mm} mm from the point, expected {least_mm} mm
-- reference: clamps off the machined zone; limit clamp_clearance_mm, by the box of the part
WITH near(point, instance, distance_mm) AS (
  SELECT p.point,
         i.instance,
         sqrt(pow(max(i.min_x_mm - p.x_mm, 0, p.x_mm - i.max_x_mm), 2)
              + pow(max(i.min_y_mm - p.y_mm, 0, p.y_mm - i.max_y_mm), 2)
              + pow(max(i.min_z_mm - p.z_mm, 0, p.z_mm - i.max_z_mm), 2))
  FROM points AS p
  CROSS JOIN instances AS i
  WHERE i.role IN ('clamp', 'locator'))
SELECT near.instance || ' ' || near.point AS subject,
       near.distance_mm >= l.value AS ok,
       near.distance_mm,
       l.value AS least_mm
FROM near
JOIN limits AS l ON l.name = 'clamp_clearance_mm'
