-- id: FST-04
-- severity: error
-- title: A screw engages its thread far enough
-- message: {subject}: {engagement_mm} mm of thread in use, expected {needed_mm} mm
-- reference: VDI 2230 sheet 1; 1 d for steel in steel by limit engagement_in_diameters
-- each: fits.shaft_instance
SELECT f.shaft_instance || '.' || f.shaft || ' ' || f.hole_instance || '.' || f.hole AS subject,
       f.engagement_mm >= l.value * f.shaft_mm - 0.001 AS ok,
       f.engagement_mm,
       l.value * f.shaft_mm AS needed_mm
FROM fits AS f
JOIN limits AS l ON l.name = 'engagement_in_diameters'
JOIN instances AS i ON i.instance = f.hole_instance
WHERE f.thread_formed = 1
  AND i.role <> 'fastener'  -- nuts are as high as their standard has them
