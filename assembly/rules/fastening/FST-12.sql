-- id: FST-12
-- severity: error
-- title: Holes in use are far enough from the edge of the workpiece
-- message: {subject}: {edge_mm} mm from its axis to the edge, expected {least_mm} mm
-- reference: 1.5 d; limit edge_in_diameters. By the workpiece's box; holes along its sides
WITH used(instance, feature) AS (
  SELECT f.hole_instance, f.hole
  FROM fits AS f
  JOIN instances AS i ON i.instance = f.hole_instance AND i.role = 'workpiece'
  UNION
  SELECT workpiece, hole FROM pins),
edges(subject, edge_mm, diameter_mm) AS (
  SELECT u.instance || '.' || u.feature,
         min(CASE WHEN abs(f.dx) > 0.999 THEN 1e9 ELSE min(f.x_mm - i.min_x_mm, i.max_x_mm - f.x_mm) END,
             CASE WHEN abs(f.dy) > 0.999 THEN 1e9 ELSE min(f.y_mm - i.min_y_mm, i.max_y_mm - f.y_mm) END,
             CASE WHEN abs(f.dz) > 0.999 THEN 1e9 ELSE min(f.z_mm - i.min_z_mm, i.max_z_mm - f.z_mm) END),
         f.diameter_mm
  FROM used AS u
  JOIN features AS f ON f.instance = u.instance AND f.feature = u.feature
  JOIN instances AS i ON i.instance = u.instance
  WHERE max(abs(f.dx), abs(f.dy), abs(f.dz)) > 0.999)
SELECT e.subject,
       e.edge_mm >= l.value * e.diameter_mm AS ok,
       e.edge_mm,
       l.value * e.diameter_mm AS least_mm,
       e.diameter_mm
FROM edges AS e
JOIN limits AS l ON l.name = 'edge_in_diameters'
