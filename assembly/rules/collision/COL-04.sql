-- id: COL-04
-- severity: error
-- title: Mated faces touch
-- message: {subject}: mate {number} is off by {off_mm} mm
-- reference: a mate that is off is no contact; 0.02 mm
-- each: mates.moving
SELECT moving || ' ' || fixed AS subject,
       max(abs(off_axis_mm), abs(off_along_mm)) <= 0.02 AS ok,
       number,
       max(abs(off_axis_mm), abs(off_along_mm)) AS off_mm
FROM mates
