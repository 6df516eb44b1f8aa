-- id: CLP-01
-- severity: error
-- title: A clamp presses over the supports
-- message: {subject} presses {outside_mm} mm outside of the polygon of the supports
-- reference: Carr Lane, clamping: over a support
-- each: clamps.instance
SELECT instance || ' ' || workpiece AS subject,
       support_margin_mm >= 0 AS ok,
       -support_margin_mm AS outside_mm,
       support_margin_mm
FROM clamps
WHERE support_margin_mm IS NOT NULL
