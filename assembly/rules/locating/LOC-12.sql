-- id: LOC-12
-- severity: warning
-- title: A locating pin is stout and short in its hole
-- message: {subject}: {length_mm} mm long and {engagement_mm} mm in the hole, expected {most_mm} mm and
--     {pin_mm} mm at most
-- reference: a pin up to 6 d long, and up to 1 d in the hole so that the workpiece goes on; limit
--     pin_slenderness
-- each: pins.instance
SELECT p.instance || ' ' || p.workpiece || '.' || p.hole AS subject,
       p.length_mm <= l.value * p.pin_mm AND p.engagement_mm <= 1.001 * p.pin_mm AS ok,
       p.length_mm,
       l.value * p.pin_mm AS most_mm,
       p.engagement_mm,
       p.pin_mm
FROM pins AS p
JOIN limits AS l ON l.name = 'pin_slenderness'
