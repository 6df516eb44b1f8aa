-- id: SYS-02
-- severity: error
-- title: Parts that stand on the base plate do not look over its edge
-- message: {subject} looks over the plate by {over_mm} mm
-- reference: footprint inside the plate
WITH standing(instance, plate) AS (
  SELECT c.a, p.instance FROM contacts AS c JOIN instances AS p ON p.instance = c.b WHERE p.role = 'base plate'
  UNION
  SELECT c.b, p.instance FROM contacts AS c JOIN instances AS p ON p.instance = c.a WHERE p.role = 'base plate')
SELECT i.instance || ' ' || p.instance AS subject,
       max(p.min_x_mm - i.min_x_mm, i.max_x_mm - p.max_x_mm, p.min_y_mm - i.min_y_mm,
           i.max_y_mm - p.max_y_mm) <= 0.01 AS ok,
       max(p.min_x_mm - i.min_x_mm, i.max_x_mm - p.max_x_mm, p.min_y_mm - i.min_y_mm,
           i.max_y_mm - p.max_y_mm) AS over_mm
FROM standing AS s
JOIN instances AS i ON i.instance = s.instance
JOIN instances AS p ON p.instance = s.plate
WHERE i.role <> 'workpiece'
