-- id: CMP-05
-- severity: warning
-- title: A counterbore has room for the head of its screw
-- message: {subject}: head of {shaft_mm} mm in {bore_mm} mm, expected 0.5 mm more
-- reference: like DIN 974-1
-- each: fits.shaft_instance
SELECT f.shaft_instance || '.' || f.shaft || ' ' || f.hole_instance || '.' || f.hole AS subject,
       f.bore_mm >= f.shaft_mm + 0.5 AS ok,
       f.shaft_mm,
       f.bore_mm
FROM fits AS f
JOIN features AS h ON h.instance = f.shaft_instance AND h.feature = f.shaft
WHERE h.use = 'head'
  AND f.hole_kind = 'hole'
