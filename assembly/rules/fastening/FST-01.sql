-- id: FST-01
-- severity: error
-- title: Every part is held: a chain of joints leads from it to the base
-- message: {subject} is held by nothing that is held
-- reference: FreeCAD-Workholding practice: coordinates locate a part, they do not hold it
WITH RECURSIVE held(instance) AS (
  SELECT instance FROM instances WHERE role = 'base plate' OR grounded = 1
  UNION
  SELECT f.instance FROM held JOIN fastenings AS f ON f.holder = held.instance)
SELECT i.instance AS subject,
       i.instance IN (SELECT instance FROM held) AS ok,
       (SELECT count(*) FROM fastenings AS f WHERE f.instance = i.instance) AS joints
FROM instances AS i
WHERE i.role <> 'base plate'
