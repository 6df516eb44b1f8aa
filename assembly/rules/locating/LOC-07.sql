-- id: LOC-07
-- severity: error
-- title: The workpiece stands by itself: its centre of mass is over the supports
-- message: {subject}: {margin_mm} mm inside the supports, expected {needed_mm} mm
-- reference: statics; limit support_margin_share
SELECT w.workpiece AS subject,
       coalesce(w.support_margin_mm >= l.value * w.length_mm, 0) AS ok,
       coalesce(w.support_margin_mm, 'no support:') AS margin_mm,
       l.value * w.length_mm AS needed_mm
FROM workpieces AS w
JOIN limits AS l ON l.name = 'support_margin_share'
