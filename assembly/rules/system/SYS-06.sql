-- id: SYS-06
-- severity: info
-- title: What is heavier than a person lifts needs a lifting point
-- message: {subject}: {mass_kg} kg, expected {largest_kg} kg or a lifting point
-- reference: limit lifting_mass_kg
-- each: instances.instance
SELECT i.instance AS subject, i.mass_kg <= l.value AS ok, i.mass_kg, l.value AS largest_kg
FROM instances AS i
JOIN limits AS l ON l.name = 'lifting_mass_kg'
WHERE i.mass_kg IS NOT NULL
