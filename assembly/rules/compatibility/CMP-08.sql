-- id: CMP-08
-- severity: error
-- title: A key fits the slots that it stands in
-- message: {subject}: {play_mm} mm of play, expected 0 to {most_mm} mm
-- reference: DIN 6323: h6 in H8; as drawn, limit locating_clearance_um
-- each: slot_fits.instance
SELECT s.instance || ' ' || s.slot_instance || '.' || s.slot AS subject,
       s.play_mm BETWEEN -0.001 AND l.value / 1000.0 AS ok,
       s.play_mm,
       l.value / 1000.0 AS most_mm,
       s.width_mm,
       s.slot_mm,
       s.fit,
       s.slot_fit
FROM slot_fits AS s
JOIN instances AS i ON i.instance = s.instance
JOIN limits AS l ON l.name = 'locating_clearance_um'
WHERE s.play_mm IS NOT NULL
  AND s.foot_width_mm IS NULL
  AND i.role = 'locator'
