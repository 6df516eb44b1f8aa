-- id: FST-08
-- severity: error
-- title: A screw is of a length that there is, and its thread is long enough
-- message: {subject}: {length_mm} mm long, expected {standard_mm} mm; {in_thread_mm} mm of it are in its
--     thread, and {thread_mm} mm have one
-- reference: nominal lengths like ISO 888 (general knowledge). A thread that does not reach the head is
--     stated by `design SCREW thread_length_mm`; fit screws have lengths of their own
WITH lengths(mm) AS (
  VALUES (3), (4), (5), (6), (8), (10), (12), (16), (20), (25), (30), (35), (40), (45), (50), (55),
         (60), (65), (70), (80), (90), (100), (110), (120), (130), (140), (150), (160), (180), (200),
         (220), (240), (260), (280), (300)),
screws(instance, length_mm, thread_mm) AS (
  SELECT w.instance, w.length_mm, s.value
  FROM wrenches AS w
  JOIN instances AS i ON i.instance = w.instance AND i.role = 'fastener'
  LEFT JOIN stated AS s ON s.subject = w.instance AND s.quantity = 'thread_length_mm'
  WHERE w.length_mm IS NOT NULL
    AND NOT EXISTS (SELECT 1 FROM features AS f
                    WHERE f.instance = w.instance AND f.kind = 'shaft' AND f.fit IS NOT NULL)),
placed(instance, length_mm, thread_mm, in_thread_mm, standard_mm, off_mm) AS (
  SELECT s.instance,
         s.length_mm,
         coalesce(s.thread_mm, s.length_mm),
         (SELECT coalesce(max(f.engagement_mm + max(0, -f.tip_to_end_mm)), 0)
          FROM fits AS f
          WHERE f.shaft_instance = s.instance AND f.thread_formed = 1),
         l.mm,
         min(abs(l.mm - s.length_mm))  -- whose row the others are of
  FROM screws AS s
  CROSS JOIN lengths AS l
  GROUP BY s.instance)
SELECT instance AS subject,
       off_mm <= 0.05 AND in_thread_mm <= thread_mm + 0.001 AS ok,
       length_mm,
       standard_mm,
       in_thread_mm,
       thread_mm
FROM placed
