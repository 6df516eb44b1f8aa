-- id: ACC-02
-- severity: error
-- title: The workpiece comes out of the fixture when the clamps are off
-- message: {subject}: in the way is {blocked_by}, after {share} of {lift_mm} mm
-- reference: Asada and By 1985 (accessibility, detachability); limit lift_mm
SELECT workpiece AS subject,
       free AS ok,
       coalesce(blocked_by, 'every direction') AS blocked_by,
       free_share AS share,
       lift_mm,
       dx,
       dy,
       dz
FROM unloading
