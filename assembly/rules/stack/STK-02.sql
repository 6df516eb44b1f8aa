-- id: STK-02
-- severity: warning
-- title: Stacks are low and of few pieces
-- message: {subject} stands on {pieces} spacers, {height_mm} mm high and {width_mm} mm wide
-- reference: few joints are stiff; limits stack_pieces and slenderness
-- each: fits.shaft_instance
WITH pieces(screw, instance, height_mm, width_mm) AS (
  SELECT DISTINCT f.shaft_instance,
         i.instance,
         i.max_z_mm - i.min_z_mm,
         min(i.max_x_mm - i.min_x_mm, i.max_y_mm - i.min_y_mm)
  FROM fits AS f
  JOIN instances AS i ON i.instance = f.hole_instance
  WHERE f.thread_formed = 0
    AND i.role = 'riser')
SELECT p.screw AS subject,
       count(*) <= n.value AND sum(p.height_mm) <= s.value * min(p.width_mm) AS ok,
       count(*) AS pieces,
       sum(p.height_mm) AS height_mm,
       min(p.width_mm) AS width_mm
FROM pieces AS p
JOIN limits AS n ON n.name = 'stack_pieces'
JOIN limits AS s ON s.name = 'slenderness'
GROUP BY p.screw
