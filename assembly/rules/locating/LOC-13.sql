-- id: LOC-13
-- severity: info
-- title: Chips find room around a locator
-- message: {subject}: {relief_mm} mm free around its root, expected {least_mm} mm
-- reference: Fundamentals of Tool Design: chip relief; limit chip_relief_mm, stated by `design
--     LOCATOR chip_relief_mm`
-- each: locators.instance
SELECT DISTINCT k.instance AS subject,
       s.value >= l.value AS ok,
       'nobody states its relief (`design ' || k.instance || ' chip_relief_mm MM reason TEXT`)'
         AS reason,
       s.value AS relief_mm,
       l.value AS least_mm
FROM locators AS k
JOIN limits AS l ON l.name = 'chip_relief_mm'
LEFT JOIN stated AS s ON s.subject = k.instance AND s.quantity = 'chip_relief_mm'
