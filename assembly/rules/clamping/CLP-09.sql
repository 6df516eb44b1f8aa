-- id: CLP-09
-- severity: warning
-- title: A clamp does not crush the workpiece
-- message: {subject}: {pressure} N/mm2, expected {largest} at most
-- reference: force over area against half the yield strength; limit pressure_N_per_mm2
SELECT c.instance || ' ' || c.workpiece AS subject,
       CASE WHEN c.force_N IS NULL THEN NULL
            ELSE c.force_N / sum(c.area_mm2) <= l.value END AS ok,
       'no clamp force is given (`force CLAMP N`)' AS reason,
       c.force_N / sum(c.area_mm2) AS pressure,
       l.value AS largest
FROM clamps AS c
JOIN limits AS l ON l.name = 'pressure_N_per_mm2'
WHERE c.area_mm2 > 0
GROUP BY c.workpiece, c.instance
