-- id: STK-05
-- severity: warning
-- title: A part bears on most of its foot
-- message: {subject}: {bearing_mm2} of {foot_mm2} mm2 of its foot bear, expected 70 %
-- reference: bearing area of 70 %
-- each: features.instance
WITH foot(instance, z_mm, foot_mm2) AS (
  SELECT f.instance, f.z_mm, f.area_mm2
  FROM features AS f
  JOIN instances AS i ON i.instance = f.instance
  WHERE f.kind = 'face'
    AND f.dz < -0.999
    AND i.role IN ('riser', 'support', 'locator')
    AND NOT EXISTS (SELECT 1 FROM slot_fits AS s WHERE s.instance = f.instance)  -- keys hang
    AND (f.use IN ('seat', 'bottom')
         OR (f.z_mm <= i.min_z_mm + 0.01
             AND NOT EXISTS (SELECT 1 FROM features AS s
                             WHERE s.instance = f.instance AND s.use IN ('seat', 'bottom'))))),
bearing(instance, foot_mm2, bearing_mm2) AS (
  SELECT foot.instance,
         foot.foot_mm2,
         (SELECT coalesce(sum(s.area_mm2), 0)
          FROM seats AS s
          WHERE s.a = foot.instance AND s.nz < -0.999 AND abs(s.z_mm - foot.z_mm) < 0.02)
         + (SELECT coalesce(sum(s.area_mm2), 0)
            FROM seats AS s
            WHERE s.b = foot.instance AND s.nz > 0.999 AND abs(s.z_mm - foot.z_mm) < 0.02)
  FROM foot)
SELECT instance AS subject,
       sum(bearing_mm2) >= 0.7 * foot_mm2 AS ok,
       sum(bearing_mm2) AS bearing_mm2,
       foot_mm2
FROM bearing
GROUP BY instance, foot_mm2
