-- id: LOC-09
-- severity: error
-- title: A diamond pin has the play that the tolerance of the centres needs
-- message: {subject}: {play_mm} mm of play, expected {needed_mm} mm for centres within {centres_mm} mm
-- reference: geometry of the land b in a hole D: D - sqrt(D2 - 4 a (a + b)), a the tolerances of both
--     centre distances less half the play of the round pin; stated by `design`: land_mm of the pin,
--     centre_tolerance_mm of workpiece and pin
WITH places(workpiece, instance, play_mm, hole_mm, land_mm, centres_mm, a_mm) AS (
  SELECT d.workpiece,
         d.instance,
         d.play_mm,
         d.hole_mm,
         b.value,
         w.value + p.value,
         max(0, w.value + p.value - 0.5 * r.play_mm)
  FROM pins AS d
  JOIN pins AS r ON r.workpiece = d.workpiece AND r.diamond = 0
  LEFT JOIN stated AS b ON b.subject = d.instance AND b.quantity = 'land_mm'
  LEFT JOIN stated AS w ON w.subject = d.workpiece AND w.quantity = 'centre_tolerance_mm'
  LEFT JOIN stated AS p ON p.subject = d.instance AND p.quantity = 'centre_tolerance_mm'
  WHERE d.diamond = 1)
SELECT instance || ' ' || workpiece AS subject,
       play_mm >= hole_mm - sqrt(max(0, hole_mm * hole_mm - 4 * a_mm * (a_mm + land_mm))) AS ok,
       'not stated: land_mm of ' || instance || ', or centre_tolerance_mm of it or ' || workpiece
         AS reason,
       play_mm,
       hole_mm - sqrt(max(0, hole_mm * hole_mm - 4 * a_mm * (a_mm + land_mm))) AS needed_mm,
       centres_mm,
       a_mm,
       land_mm
FROM places
