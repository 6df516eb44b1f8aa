-- id: COL-03
-- severity: warning
-- title: Parts that do not touch keep a gap
-- message: {subject}: {gap_mm} mm apart, expected {least_mm} mm
-- reference: limits gap_element_mm and gap_workpiece_mm
-- each: clearances.a
SELECT c.a || ' ' || c.b AS subject,
       c.gap_mm >= l.value AS ok,
       c.gap_mm,
       l.value AS least_mm
FROM clearances AS c
JOIN instances AS a ON a.instance = c.a
JOIN instances AS b ON b.instance = c.b
JOIN limits AS l ON l.name = CASE WHEN a.role = 'workpiece' OR b.role = 'workpiece'
                                  THEN 'gap_workpiece_mm' ELSE 'gap_element_mm' END
WHERE NOT EXISTS (SELECT 1 FROM fits AS f WHERE f.shaft_instance = c.a AND f.hole_instance = c.b)
  AND NOT EXISTS (SELECT 1 FROM fits AS f WHERE f.shaft_instance = c.b AND f.hole_instance = c.a)
  -- its play is its fit's; nor a screw that is sunk in what carries the workpiece
  AND NOT EXISTS (SELECT 1
                  FROM fits AS f
                  JOIN workpiece_contacts AS w ON w.instance = f.hole_instance
                  WHERE f.shaft_instance = c.a AND w.workpiece = c.b)
  AND NOT EXISTS (SELECT 1
                  FROM fits AS f
                  JOIN workpiece_contacts AS w ON w.instance = f.hole_instance
                  WHERE f.shaft_instance = c.b AND w.workpiece = c.a)
