-- id: CLP-08
-- severity: warning
-- title: The screw of a strap is nearer to the workpiece than to the heel
-- message: {subject}: the workpiece gets {share} of the force of {screw}, expected {least}
-- reference: lever: heel over heel and nose; limit strap_lever
-- each: straps.instance
SELECT s.instance || ' ' || s.workpiece AS subject,
       s.share >= l.value AS ok,
       s.share,
       l.value AS least,
       s.screw,
       s.heel_length_mm,
       s.nose_length_mm,
       s.screw_force_N
FROM straps AS s
JOIN limits AS l ON l.name = 'strap_lever'
