-- id: ACC-06
-- severity: info
-- title: A hand has room beside a clamp that it works
-- message: {subject}: on no side of it are {hand_mm} mm free
-- reference: 60 mm for a hand, by the boxes of the parts; limit hand_mm, stated by `design CLAMP manual
--     1`
WITH sides(side, x, y, z) AS (
  VALUES ('right', 1, 0, 0), ('left', -1, 0, 0), ('back', 0, 1, 0), ('front', 0, -1, 0),
         ('top', 0, 0, 1)),
rooms(instance, side, hand_mm, x0, x1, y0, y1, z0, z1) AS (
  SELECT c.instance,
         s.side,
         l.value,
         CASE s.x WHEN 1 THEN c.max_x_mm WHEN -1 THEN c.min_x_mm - l.value ELSE c.min_x_mm END,
         CASE s.x WHEN 1 THEN c.max_x_mm + l.value WHEN -1 THEN c.min_x_mm ELSE c.max_x_mm END,
         CASE s.y WHEN 1 THEN c.max_y_mm WHEN -1 THEN c.min_y_mm - l.value ELSE c.min_y_mm END,
         CASE s.y WHEN 1 THEN c.max_y_mm + l.value WHEN -1 THEN c.min_y_mm ELSE c.max_y_mm END,
         CASE s.z WHEN 1 THEN c.max_z_mm ELSE c.min_z_mm END,
         CASE s.z WHEN 1 THEN c.max_z_mm + l.value ELSE c.max_z_mm END
  FROM stated AS m
  JOIN instances AS c ON c.instance = m.subject
  JOIN limits AS l ON l.name = 'hand_mm'
  CROSS JOIN sides AS s
  WHERE m.quantity = 'manual'
    AND m.value = 1),
parts(instance, side, hand_mm, in_room) AS (
  SELECT r.instance,
         r.side,
         r.hand_mm,
         (SELECT min(i.instance)
          FROM instances AS i
          WHERE i.instance <> r.instance
            AND i.min_x_mm < r.x1 - 0.01 AND i.max_x_mm > r.x0 + 0.01
            AND i.min_y_mm < r.y1 - 0.01 AND i.max_y_mm > r.y0 + 0.01
            AND i.min_z_mm < r.z1 - 0.01 AND i.max_z_mm > r.z0 + 0.01)
  FROM rooms AS r)
SELECT instance AS subject,
       max(in_room IS NULL) AS ok,
       hand_mm,
       coalesce(group_concat(CASE WHEN in_room IS NULL THEN side END, ', '), 'none') AS free_sides
FROM parts
GROUP BY instance
