-- id: CLP-11
-- severity: warning
-- title: Cutting forces go to fixed stops, not to clamps
-- message: {subject}: {against_N} N of the load press against the clamp
-- reference: clamps should not be relied upon to hold the workpiece against the cutting force
--     (Fundamentals of Tool Design)
SELECT c.load || ' ' || k.instance AS subject,
       c.fx_N * k.nx + c.fy_N * k.ny + c.fz_N * k.nz >= -0.001 AS ok,
       -(c.fx_N * k.nx + c.fy_N * k.ny + c.fz_N * k.nz) AS against_N
FROM loads AS c
JOIN clamps AS k ON k.workpiece = c.workpiece
