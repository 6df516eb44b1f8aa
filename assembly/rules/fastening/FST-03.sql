-- id: FST-03
-- severity: error
-- title: A locator or support on screws is located by a fit, not by clearance
-- message: {subject} stands on screws with {most_um} um of clearance at least
-- reference: Carr Lane, locating: a screw in a clearance hole leaves tenths of a millimetre
WITH joined(instance, most_um) AS (
  SELECT hole_instance, coalesce(most_clearance_um, 1000.0 * (bore_mm - shaft_mm))
  FROM fits
  WHERE coaxial = 1
    AND thread_formed = 0
    AND hole_kind = 'hole'
  UNION ALL
  SELECT shaft_instance, most_clearance_um
  FROM fits
  WHERE coaxial = 1
    AND most_clearance_um IS NOT NULL
  UNION ALL
  SELECT k.holder, 1000.0 * sum(s.play_mm)
  FROM fastenings AS k
  JOIN slot_fits AS s ON s.instance = k.instance
  WHERE k.kind = 'key'
  GROUP BY k.instance, k.holder)
SELECT i.instance AS subject,
       min(j.most_um) <= l.value AS ok,
       min(j.most_um) AS most_um,
       l.value AS limit_um
FROM instances AS i
JOIN joined AS j ON j.instance = i.instance
JOIN limits AS l ON l.name = 'locating_clearance_um'
WHERE i.role IN ('locator', 'support')
GROUP BY i.instance
