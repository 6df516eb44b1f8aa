-- id: COL-07
-- severity: error
-- title: No verdict hangs on facets
-- message: {subject}: facets may be off by {bound_mm} mm, more than the tolerance; a finer import
--     decides
-- reference: incomplete is not passed
-- each: contacts.a, interferences.a
SELECT a || ' ' || b AS subject, bound_mm <= 0.1 AS ok, bound_mm
FROM (SELECT a, b, bound_mm FROM contacts UNION ALL SELECT a, b, bound_mm FROM interferences)
