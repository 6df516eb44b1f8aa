-- id: FST-10
-- severity: error
-- title: A feature has one occupant
-- message: {subject} is mated with {occupants}
-- reference: one feature, one mate of a kind
-- each: mates.fixed
SELECT fixed || '.' || fixed_feature AS subject,
       count(DISTINCT moving) = 1 AS ok,
       group_concat(DISTINCT moving) AS occupants
FROM mates
WHERE kind = 'shaft in hole'
GROUP BY fixed, fixed_feature
