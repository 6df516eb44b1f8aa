-- id: CLP-12
-- severity: warning
-- title: A clamp's pad is on the workpiece
-- message: {subject}: {share} of its pad bears, expected {least}
-- reference: pad on the face; limit pad_share_clamp. Of a strap its nose, of the size that is stated
--     by `design CLAMP pad_mm2`
-- each: pads.instance
SELECT p.instance || ' ' || p.workpiece AS subject,
       min(1.0, p.area_mm2 / s.value) >= l.value AS ok,
       'the size of its pad is not stated (`design ' || p.instance || ' pad_mm2 MM2 reason TEXT`)'
         AS reason,
       min(1.0, p.area_mm2 / s.value) AS share,
       l.value AS least,
       p.area_mm2,
       s.value AS pad_mm2
FROM pads AS p
JOIN limits AS l ON l.name = 'pad_share_clamp'
LEFT JOIN stated AS s ON s.subject = p.instance AND s.quantity = 'pad_mm2'
WHERE p.role = 'clamp'
