-- id: CLP-05
-- severity: info
-- title: The contacts hold the workpiece without friction
-- message: {subject} has no form closure: clamps hold it by friction
-- reference: Brost and Goldberg, IEEE Trans. Robotics and Automation 12(1), 1996
SELECT workpiece AS subject, form_closure AS ok, points
FROM workpieces
