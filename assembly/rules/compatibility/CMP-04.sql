-- id: CMP-04
-- severity: error
-- title: A clearance hole is neither too tight nor too wide for its screw
-- message: {subject}: {bore_mm} mm for {shaft_thread}, expected {fine_mm} to {coarse_mm} mm
-- reference: ISO 273
-- each: fits.shaft_instance
WITH clearance(nominal_mm, fine_mm, coarse_mm) AS (
  VALUES (3, 3.2, 3.6), (4, 4.3, 4.8), (5, 5.3, 5.8), (6, 6.4, 7.0), (8, 8.4, 10.0),
         (10, 10.5, 12.0), (12, 13.0, 14.5), (16, 17.0, 18.5), (20, 21.0, 24.0), (24, 25.0, 28.0))
SELECT f.shaft_instance || '.' || f.shaft || ' ' || f.hole_instance || '.' || f.hole AS subject,
       f.bore_mm BETWEEN c.fine_mm AND c.coarse_mm AS ok,
       f.bore_mm,
       f.shaft_thread,
       c.fine_mm,
       c.coarse_mm
FROM fits AS f
JOIN clearance AS c ON c.nominal_mm = f.shaft_mm
JOIN fastenings AS j ON j.instance = f.shaft_instance AND j.holder = f.hole_instance AND j.kind = 'screw'
WHERE f.shaft_thread IS NOT NULL
  AND f.hole_kind = 'hole'
  AND f.hole_fit IS NULL      -- a fit screw's own bore
  AND f.hole_thread IS NULL
