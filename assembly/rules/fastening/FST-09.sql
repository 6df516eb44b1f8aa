-- id: FST-09
-- severity: warning
-- title: A locator cannot turn about its only screw
-- message: {subject} is held by {joints} joint without a key, and can turn about it
-- reference: two screws, or a screw and a pin or key
-- each: instances.instance
SELECT i.instance AS subject,
       count(DISTINCT f.holder) >= 2
         OR EXISTS (SELECT 1 FROM fastenings AS k WHERE k.holder = i.instance AND k.kind = 'key')
         AS ok,
       count(DISTINCT f.holder) AS joints
FROM instances AS i
JOIN fastenings AS f ON f.instance = i.instance
WHERE i.role = 'locator'
  AND f.kind = 'screw'
GROUP BY i.instance
