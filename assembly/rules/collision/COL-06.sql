-- id: COL-06
-- severity: error
-- title: A screw comes to its place along its axis
-- message: {subject}: {stopped_by} is in its way
-- reference: Peng et al. 2009: the path of insertion; the room that the head goes through is a
--     cylinder, so that no place on the way is left out
-- each: wrenches.instance
SELECT instance AS subject, comes_in AS ok, coalesce(stopped_by, 'nothing') AS stopped_by
FROM wrenches
WHERE comes_in IS NOT NULL
