-- id: CMP-09
-- severity: warning
-- title: Spherical washers and conical seats come in pairs
-- message: {subject}: its {side} meets no {expected}
-- reference: DIN 6319: form C turns in D or G; either alone bears on an edge
-- each: spherical_washers.instance
SELECT instance AS subject,
       partner IS NOT NULL AS ok,
       side,
       CASE side WHEN 'ball' THEN 'conical seat' ELSE 'spherical washer' END AS expected,
       partner
FROM spherical_washers
