-- id: SYS-05
-- severity: info
-- title: A base plate on another one is held in place by two keys or pins
-- message: {subject}: {count} keys and pins stand in both, expected 2
-- reference: Carr Lane, referencing a plate on the machine table
WITH stacked(plate, under) AS (
  SELECT s.b, s.a
  FROM seats AS s
  JOIN instances AS p ON p.instance = s.b AND p.role = 'base plate'
  JOIN instances AS t ON t.instance = s.a AND t.role = 'base plate'
  WHERE s.nz > 0.999
  UNION
  SELECT s.a, s.b
  FROM seats AS s
  JOIN instances AS p ON p.instance = s.a AND p.role = 'base plate'
  JOIN instances AS t ON t.instance = s.b AND t.role = 'base plate'
  WHERE s.nz < -0.999),
standing(instance, plate) AS (
  SELECT instance, holder FROM fastenings WHERE kind = 'key'
  UNION
  SELECT shaft_instance, hole_instance
  FROM fits
  WHERE coaxial = 1
    AND thread_formed = 0
    AND most_clearance_um <= 50)
SELECT s.plate || ' ' || s.under AS subject,
       count(DISTINCT a.instance) >= 2 AS ok,
       count(DISTINCT a.instance) AS count
FROM stacked AS s
LEFT JOIN standing AS a ON a.plate = s.plate
                       AND EXISTS (SELECT 1 FROM standing AS b
                                   WHERE b.instance = a.instance AND b.plate = s.under)
GROUP BY s.plate, s.under
