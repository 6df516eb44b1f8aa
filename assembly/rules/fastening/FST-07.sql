-- id: FST-07
-- severity: warning
-- title: A nut is fully on its thread
-- message: {subject}: the screw looks out of the nut by {out_mm} mm, expected a pitch of {pitch_mm}
--     mm
-- reference: ISO 4161 practice: two threads or one pitch beyond the nut
-- each: fits.shaft_instance
SELECT f.shaft_instance || '.' || f.shaft || ' ' || f.hole_instance || '.' || f.hole AS subject,
       min(f.past_opening_mm, -f.tip_to_end_mm) >= f.pitch_mm - 0.001 AS ok,
       min(f.past_opening_mm, -f.tip_to_end_mm) AS out_mm,
       f.pitch_mm
FROM fits AS f
JOIN instances AS i ON i.instance = f.hole_instance
WHERE f.thread_formed = 1
  AND f.through = 1
  AND NOT EXISTS (SELECT 1 FROM slot_fits AS s  -- T-nuts: FST-06
                  WHERE s.instance = f.hole_instance AND s.foot_width_mm IS NOT NULL)
  AND i.role = 'fastener'
