-- id: LOC-08
-- severity: error
-- title: Two holes are located by a round and a diamond pin, not by two round ones
-- message: {subject}: the pins in its holes hold {points} ways, expected {directions} at most; turn
--     one into a diamond that gives way along the line of centres
-- reference: DIN 6321; Carr Lane, locating from two holes
SELECT workpiece AS subject,
       count(*) <= 3 AS ok,
       count(*) AS points,
       3 AS directions
FROM locators
WHERE two_sided = 1
GROUP BY workpiece
HAVING count(DISTINCT x_mm || ' ' || y_mm) = 2
