-- id: FST-05
-- severity: error
-- title: A screw does not bottom in its hole
-- message: {subject}: {left_mm} mm from the tip to the end of the thread, expected a pitch of
--     {pitch_mm} mm
-- reference: one pitch to spare, as fastening chooses screws
-- each: fits.shaft_instance
SELECT shaft_instance || '.' || shaft || ' ' || hole_instance || '.' || hole AS subject,
       tip_to_end_mm >= pitch_mm - 0.001 AS ok,
       tip_to_end_mm AS left_mm,
       pitch_mm
FROM fits
WHERE thread_formed = 1
  AND through = 0
