-- id: LOC-11
-- severity: warning
-- title: Locators bear on machined faces of the workpiece
-- message: {subject}: {share} of its pad bears, expected {least}, and {face} is machined: {machined}
-- reference: Carr Lane: locate on machined faces; limit pad_share_locator. Stated by `design
--     WORKPIECE.FACE machined 1`
-- each: pads.instance
SELECT p.instance || ' ' || p.workpiece || '.' || p.face AS subject,
       CASE WHEN m.value IS NULL THEN NULL
            ELSE m.value = 1 AND p.area_mm2 >= l.value * min(p.pad_mm2, coalesce(s.value, p.pad_mm2))
            END AS ok,
       'nobody states whether the face is machined (`design ' || p.workpiece || '.' || p.face
         || ' machined 1 reason TEXT`)' AS reason,
       min(1.0, p.area_mm2 / min(p.pad_mm2, coalesce(s.value, p.pad_mm2))) AS share,
       l.value AS least,
       m.value AS machined,
       p.face,
       p.area_mm2,
       min(p.pad_mm2, coalesce(s.value, p.pad_mm2)) AS pad_mm2
FROM pads AS p
JOIN limits AS l ON l.name = 'pad_share_locator'
LEFT JOIN stated AS m ON m.subject = p.workpiece || '.' || p.face AND m.quantity = 'machined'
LEFT JOIN stated AS s ON s.subject = p.instance AND s.quantity = 'pad_mm2'
WHERE p.role IN ('locator', 'support')
  AND p.face IS NOT NULL
  AND p.pad IS NOT NULL
