-- id: CMP-02
-- severity: error
-- title: A screw and the thread it is in are of one size
-- message: {subject}: thread {shaft_thread} in {hole_thread}
-- reference: ISO 965-1; ISO 261
-- each: fits.shaft_instance
SELECT shaft_instance || '.' || shaft || ' ' || hole_instance || '.' || hole AS subject,
       shaft_thread = hole_thread AS ok,
       shaft_thread,
       hole_thread,
       shaft_mm,
       bore_mm
FROM fits
WHERE coaxial = 1
  AND shaft_thread IS NOT NULL
  AND hole_thread IS NOT NULL
  AND shaft_mm >= bore_mm  -- a thinner one passes
