-- id: LOC-05
-- severity: warning
-- title: The supports are far apart
-- message: {subject}: supports span {support_area_mm2} mm2, expected {share} of {box_mm2} mm2
-- reference: locators as far apart as can be; 0.3 of the face
SELECT w.workpiece AS subject,
       w.support_area_mm2 >= 0.3 * (i.max_x_mm - i.min_x_mm) * (i.max_y_mm - i.min_y_mm) AS ok,
       w.support_area_mm2,
       0.3 AS share,
       (i.max_x_mm - i.min_x_mm) * (i.max_y_mm - i.min_y_mm) AS box_mm2
FROM workpieces AS w
JOIN instances AS i ON i.instance = w.workpiece
