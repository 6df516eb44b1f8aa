-- id: CMP-06
-- severity: error
-- title: A head or nut bears all around its bore
-- message: {subject}: it bears on {bearing_mm2} mm2, expected {least_mm2} mm2; put a washer under it
-- reference: a ring of 0.1 d, as DIN 6340 washers leave; limit head_bearing_in_diameters
-- each: fits.shaft_instance
WITH carried(screw, part, bore_mm, thread_mm) AS (
  SELECT f.shaft_instance, f.hole_instance, min(f.bore_mm), max(t.shaft_mm)
  FROM fits AS f
  JOIN fits AS t ON t.shaft_instance = f.shaft_instance AND t.thread_formed = 1
  JOIN instances AS i ON i.instance = f.shaft_instance
  WHERE f.thread_formed = 0
    AND f.hole_kind = 'hole'
    AND i.role = 'fastener'
  GROUP BY f.shaft_instance, f.hole_instance),
bearing(screw, part, bore_mm, thread_mm, area_mm2) AS (
  SELECT c.screw,
         c.part,
         c.bore_mm,
         c.thread_mm,
         (SELECT sum(area_mm2)
          FROM (SELECT area_mm2 FROM seats WHERE a = c.screw AND b = c.part
                UNION ALL
                SELECT area_mm2 FROM seats WHERE a = c.part AND b = c.screw))
  FROM carried AS c)
SELECT c.screw || ' ' || c.part AS subject,
       c.area_mm2 >= 0.9 * pi() * l.value * c.thread_mm * (c.bore_mm + l.value * c.thread_mm) AS ok,
       c.area_mm2 AS bearing_mm2,
       0.9 * pi() * l.value * c.thread_mm * (c.bore_mm + l.value * c.thread_mm) AS least_mm2,
       c.bore_mm,
       c.thread_mm
FROM bearing AS c
JOIN limits AS l ON l.name = 'head_bearing_in_diameters'
WHERE c.area_mm2 IS NOT NULL
