-- id: FST-06
-- severity: error
-- title: A screw is far enough in its T-nut and off the floor of the slot
-- message: {subject}: {engagement_mm} mm of thread in use, expected {needed_mm} mm; {tip_floor_mm} mm
--     from its tip to the floor, expected {floor_mm} mm
-- reference: DIN 508: the thread in use carries all; 0.9 of limit engagement_in_diameters, for the nut
--     is heat-treated, or the whole nut; limit floor_gap_mm
-- each: slot_fits.instance
SELECT f.shaft_instance || ' ' || f.hole_instance AS subject,
       f.engagement_mm >= min(0.9 * e.value * f.shaft_mm, f.overlap_mm + max(f.tip_to_end_mm, 0)) - 0.001
         AND s.floor_mm + f.tip_to_end_mm >= g.value - 0.001 AS ok,
       f.engagement_mm,
       0.9 * e.value * f.shaft_mm AS needed_mm,
       s.floor_mm + f.tip_to_end_mm AS tip_floor_mm,
       g.value AS floor_mm
FROM slot_fits AS s
JOIN fits AS f ON f.hole_instance = s.instance AND f.thread_formed = 1
JOIN limits AS e ON e.name = 'engagement_in_diameters'
JOIN limits AS g ON g.name = 'floor_gap_mm'
WHERE s.tee = 1
  AND s.foot_width_mm IS NOT NULL
