-- id: COL-02
-- severity: error
-- title: Mated parts are not in each other but for their thread
-- message: {subject} are mated and in each other by {depth_mm} mm or more, at {x_mm} {y_mm} {z_mm}
-- reference: Peng et al. 2009, with the hole exact instead of left out
SELECT m.moving || ' ' || m.fixed AS subject,
       x.depth_mm IS NULL AS ok,
       x.depth_mm,
       x.x_mm,
       x.y_mm,
       x.z_mm
FROM (SELECT DISTINCT moving, fixed FROM mates) AS m
LEFT JOIN interferences AS x ON (x.a = m.moving AND x.b = m.fixed) OR (x.a = m.fixed AND x.b = m.moving)
