-- id: ACC-01
-- severity: warning
-- title: A wrench gets onto every screw and nut and turns it
-- message: {subject}: {wrench} is stopped by {blocked_by}, or its lever of {lever_mm} mm swings by
--     {swing_deg} degrees, expected {least_deg}
-- reference: keys like ISO 2936, sockets like ISO 2725-1, spanners like DIN 3110 (general knowledge);
--     limit swing_deg
-- each: wrenches.instance
SELECT w.instance AS subject,
       w.free = 1 AND w.swing_deg >= l.value AS ok,
       w.wrench,
       coalesce(w.blocked_by, 'nothing') AS blocked_by,
       w.lever_mm,
       w.swing_deg,
       l.value AS least_deg,
       w.before_workpiece
FROM wrenches AS w
JOIN limits AS l ON l.name = 'swing_deg'
