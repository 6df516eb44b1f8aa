-- id: CMP-07
-- severity: error
-- title: A T-nut or T-bolt suits its slot
-- message: {subject}: {play_mm} mm of play in the throat, foot {foot_width_mm} x {foot_height_mm} mm
--     in an undercut of {undercut_width_mm} x {undercut_height_mm} mm, out of the slot by {out_mm} mm
-- reference: ISO 299 (slots) and DIN 508 (nuts): neck 0.1 mm and foot 0.5 mm narrower, foot not
--     higher; limit slot_play_mm. A nut is not to look out; a T-bolt does
-- each: slot_fits.instance
SELECT s.instance || ' ' || s.slot_instance || '.' || s.slot AS subject,
       (s.play_mm IS NULL OR s.play_mm >= l.value)
         AND s.foot_width_mm <= s.undercut_width_mm - 0.5
         AND s.foot_height_mm <= s.undercut_height_mm
         AND (s.out_mm <= 0
              OR EXISTS (SELECT 1 FROM fits AS f WHERE f.shaft_instance = s.instance)) AS ok,
       s.play_mm,
       l.value AS least_play_mm,
       s.foot_width_mm,
       s.undercut_width_mm,
       s.foot_height_mm,
       s.undercut_height_mm,
       s.out_mm
FROM slot_fits AS s
JOIN limits AS l ON l.name = 'slot_play_mm'
WHERE s.tee = 1
  AND s.foot_width_mm IS NOT NULL
