-- id: SYS-01
-- severity: warning
-- title: A part with bores stands with one of them on the grid or over a slot
-- message: {subject}: its nearest bore is {off_mm} mm off the holes and slots of the plate, expected
--     {most_mm} mm at most
-- reference: Peng et al. 2009: elements of modular systems stand on the pattern; limits grid_mm and
--     slot_line_mm
WITH places(instance, plate, off_mm, most_mm) AS (
  SELECT h.instance, h.plate, h.off_mm, l.value
  FROM plate_holes AS h
  JOIN limits AS l ON l.name = 'grid_mm'
  UNION ALL
  SELECT s.instance, s.plate, s.off_mm, l.value
  FROM plate_slots AS s
  JOIN limits AS l ON l.name = 'slot_line_mm')
SELECT instance || ' ' || plate AS subject,
       max(off_mm <= most_mm) AS ok,
       min(off_mm) AS off_mm,
       max(most_mm) AS most_mm,
       count(*) AS places
FROM places
GROUP BY instance, plate
