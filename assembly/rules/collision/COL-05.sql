-- id: COL-05
-- severity: error
-- title: No part is placed twice at one place
-- message: {subject}: both are {element}, at the same place
-- reference: IfcOpenShell practice: duplicates hide in each other
-- each: contacts.a, interferences.a
SELECT a.instance || ' ' || b.instance AS subject,
       abs(a.x_mm - b.x_mm) + abs(a.y_mm - b.y_mm) + abs(a.z_mm - b.z_mm) > 0.01 AS ok,
       a.element
FROM (SELECT a, b FROM contacts UNION ALL SELECT a, b FROM interferences) AS i
JOIN instances AS a ON a.instance = i.a
JOIN instances AS b ON b.instance = i.b AND b.element = a.element
