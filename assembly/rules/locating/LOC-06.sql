-- id: LOC-06
-- severity: error
-- title: The locators hold a critical point as well as its tolerance asks
-- message: {subject}: up to {worst_mm} mm off, expected {allowed_mm} mm at most
-- reference: Asada and By 1985; Wang, IEEE Trans. Robotics and Automation 16(4), 2000; limit
--     error_share
SELECT p.point AS subject,
       CASE WHEN p.worst_mm IS NULL THEN NULL ELSE p.worst_mm <= l.value * p.tolerance_mm END AS ok,
       'the locators do not settle the workpiece' AS reason,
       p.worst_mm,
       p.p95_mm,
       l.value * p.tolerance_mm AS allowed_mm
FROM points AS p
JOIN limits AS l ON l.name = 'error_share'
