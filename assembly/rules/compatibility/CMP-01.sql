-- id: CMP-01
-- severity: error
-- title: Parts that are fastened to each other are of one family
-- message: {subject}: {family} and {other_family} are systems of different pitch and thread
-- reference: Rong and Bai, Fixture Design for Workpiece Positioning, chapter on modular systems
-- each: fastenings.instance
SELECT f.instance || ' ' || f.holder AS subject,
       CASE WHEN a.family = '' OR b.family = '' THEN NULL ELSE a.family = b.family END AS ok,
       'the family of one is not stated' AS reason,
       a.family AS family,
       b.family AS other_family
FROM fastenings AS f
JOIN instances AS a ON a.instance = f.instance
JOIN instances AS b ON b.instance = f.holder
WHERE f.instance < f.holder
  AND f.kind <> 'clamp'
  AND a.role <> 'fastener'  -- systems share standard screws; CMP-02 and CMP-04 look at their size
  AND b.role <> 'fastener'
  AND a.role <> 'workpiece'
  AND b.role <> 'workpiece'
GROUP BY f.instance, f.holder
