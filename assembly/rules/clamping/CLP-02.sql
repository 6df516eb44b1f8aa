-- id: CLP-02
-- severity: error
-- title: The clamps seat the workpiece on all locators
-- message: {subject}: {seating_N} N under clamps and weight, expected {least_N} N or more; below 0
--     it lifts
-- reference: Asada and By 1985 (total restraint); limit seating_N
SELECT l.instance || ' ' || l.workpiece AS subject,
       CASE WHEN l.seating_N IS NULL THEN NULL
            ELSE l.two_sided = 1 OR l.seating_N >= m.value - 0.001 END AS ok,
       'no clamp force is given (`force CLAMP N`), or the locators do not settle the workpiece'
         AS reason,
       l.seating_N,
       m.value AS least_N
FROM locators AS l
JOIN limits AS m ON m.name = 'seating_N'
