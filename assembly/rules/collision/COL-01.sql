-- id: COL-01
-- severity: error
-- title: Parts that are not mated are not in each other
-- message: {subject} are in each other by {depth_mm} mm or more, at {x_mm} {y_mm} {z_mm}
-- reference: Peng et al. 2009
-- each: contacts.a, interferences.a
SELECT i.a || ' ' || i.b AS subject,
       x.depth_mm IS NULL AS ok,
       x.depth_mm,
       x.x_mm,
       x.y_mm,
       x.z_mm
FROM (SELECT a, b FROM contacts UNION ALL SELECT a, b FROM interferences) AS i
LEFT JOIN interferences AS x ON x.a = i.a AND x.b = i.b
WHERE NOT EXISTS (SELECT 1 FROM mates AS m WHERE m.moving = i.a AND m.fixed = i.b)
  AND NOT EXISTS (SELECT 1 FROM mates AS m WHERE m.moving = i.b AND m.fixed = i.a)
