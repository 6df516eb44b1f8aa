-- id: CLP-03
-- severity: warning
-- title: A clamp presses towards a locator
-- message: {subject} presses within {off_deg} degrees of no locator, expected 30
-- reference: clamp toward the locators: within 30 degrees
-- each: clamps.instance
SELECT instance || ' ' || workpiece AS subject,
       CASE WHEN toward IS NULL THEN NULL ELSE toward <= -0.866 END AS ok,
       'there is no locator' AS reason,
       round(degrees(acos(min(1.0, max(-1.0, -toward)))), 1) AS off_deg,
       toward
FROM clamps
