-- id: CMP-10
-- severity: warning
-- title: All holes of a part are over holes of the plate that it stands on
-- message: {subject}: {off_mm} mm off the nearest hole, expected {most_mm} mm at most
-- reference: a part off the pattern cannot be screwed down; limit grid_mm. A bore that is off by more
--     than half its diameter is for something else
-- each: plate_holes.instance
SELECT h.instance || ' ' || h.plate AS subject,
       max(h.off_mm) <= l.value AS ok,
       max(h.off_mm) AS off_mm,
       l.value AS most_mm,
       count(*) AS holes
FROM plate_holes AS h
JOIN limits AS l ON l.name = 'grid_mm'
WHERE h.off_mm < 0.5 * h.diameter_mm
GROUP BY h.instance, h.plate
