-- id: CLP-07
-- severity: warning
-- title: A strap lies level
-- message: {subject}: tilted by {tilt_deg} degrees, expected {most_deg} at most, on its heel
--     {heel}
-- reference: beyond 3 degrees spherical washers; limit strap_tilt_deg
-- each: straps.instance
SELECT s.instance || ' ' || s.workpiece AS subject,
       abs(s.tilt_deg) <= l.value AS ok,
       s.tilt_deg,
       l.value AS most_deg,
       s.heel
FROM straps AS s
JOIN limits AS l ON l.name = 'strap_tilt_deg'
