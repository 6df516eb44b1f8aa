-- id: LOC-02
-- severity: error
-- title: The locators settle all six freedoms of the workpiece
-- message: {subject}: the locator matrix of {points} points has rank {rank}, expected 6
-- reference: Asada and By, IEEE J. Robotics and Automation 1(2), 1985
SELECT workpiece AS subject, rank = 6 AS ok, rank, points
FROM workpieces
