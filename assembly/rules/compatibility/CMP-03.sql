-- id: CMP-03
-- severity: error
-- title: A shaft in a bore of a stated class locates or is pressed in
-- message: {subject}: {hole_fit}/{shaft_fit} leaves {least_clearance_um} to {most_clearance_um} um
-- reference: ISO 286-1; up to 50 um by limit locating_clearance_um
-- each: fits.shaft_instance
SELECT shaft_instance || '.' || shaft || ' ' || hole_instance || '.' || hole AS subject,
       (least_clearance_um >= 0 AND most_clearance_um <= l.value)
         OR least_clearance_um + most_clearance_um < 0 AS ok,
       hole_fit,
       shaft_fit,
       least_clearance_um,
       most_clearance_um,
       l.value AS limit_um
FROM fits
JOIN limits AS l ON l.name = 'locating_clearance_um'
WHERE coaxial = 1
  AND least_clearance_um IS NOT NULL
