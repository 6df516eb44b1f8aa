-- id: FST-11
-- severity: warning
-- title: A screw carries its preload
-- message: {subject}: {force_N} N, expected {largest_N} N at most; tightened with {torque_Nm} N m
-- reference: VDI 2230: 75 % of the yield strength over the stress area of ISO 898-1; torque
--     0.2 F d; limit screw_yield_N_per_mm2. The preload is stated by `design SCREW preload_N`; the
--     screw of a strap has at least the force that gives the strap's
-- each: fits.shaft_instance
WITH loaded(screw, thread_mm, pitch_mm) AS (
  SELECT f.shaft_instance, max(f.shaft_mm), max(f.pitch_mm)
  FROM fits AS f
  JOIN instances AS i ON i.instance = f.shaft_instance
  WHERE f.thread_formed = 1
    AND i.role = 'fastener'
  GROUP BY f.shaft_instance),
forces(screw, thread_mm, pitch_mm, force_N) AS (
  SELECT d.screw,
         d.thread_mm,
         d.pitch_mm,
         nullif(max(coalesce(s.value, 0), coalesce(max(t.screw_force_N), 0)), 0)
  FROM loaded AS d
  LEFT JOIN stated AS s ON s.subject = d.screw AND s.quantity = 'preload_N'
  LEFT JOIN straps AS t ON t.screw = d.screw
  GROUP BY d.screw)
SELECT f.screw AS subject,
       f.force_N <= 0.75 * y.value * pi() / 4.0 * pow(f.thread_mm - 0.9382 * f.pitch_mm, 2) AS ok,
       'its preload is not stated (`design ' || f.screw || ' preload_N N reason TEXT`)' AS reason,
       f.force_N,
       0.75 * y.value * pi() / 4.0 * pow(f.thread_mm - 0.9382 * f.pitch_mm, 2) AS largest_N,
       0.0002 * f.force_N * f.thread_mm AS torque_Nm,
       y.value AS yield_N_per_mm2
FROM forces AS f
JOIN limits AS y ON y.name = 'screw_yield_N_per_mm2'
