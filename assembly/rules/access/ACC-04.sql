-- id: ACC-04
-- severity: error
-- title: A cutter comes down to its point clear of the fixture
-- message: {subject}: {in_way} is in the way of the cutter of {cutter_mm} mm
-- reference: Hu and Rong 2000: the swept cutter against the fixture; limit cutter_clearance_mm,
--     stated by `design POINT cutter_mm` and cutter_length_mm, from above
SELECT point AS subject,
       free AS ok,
       'its cutter is not stated (`design ' || point || ' cutter_mm MM reason TEXT`, and its '
         || 'cutter_length_mm)' AS reason,
       cutter_mm,
       length_mm,
       coalesce(in_way, 'nothing') AS in_way
FROM cutters
