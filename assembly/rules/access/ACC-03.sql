-- id: ACC-03
-- severity: warning
-- title: The workpiece seats in no wrong orientation
-- message: {subject} seats when it is turned, too: {turns}
-- reference: foolproofing (Fundamentals of Tool Design): what goes in wrong once will be machined
--     wrong; quarter, third and half turns about the axes of its box
SELECT workpiece AS subject,
       sum(seats) = 0 AS ok,
       coalesce(group_concat(CASE WHEN seats = 1
                                  THEN printf('%d degrees about %g %g %g', angle_deg,
                                              round(dx, 3) + 0.0, round(dy, 3) + 0.0,
                                              round(dz, 3) + 0.0) END, '; '), 'none') AS turns,
       count(*) AS tried,
       sum(seats) AS seated
FROM orientations
GROUP BY workpiece
