-- id: SYS-03
-- severity: error
-- title: The fixture goes under the tool and onto the table
-- message: {subject}: {height_mm} mm high and {mass_kg} kg, expected {largest_mm} mm and
--     {largest_kg} kg
-- reference: limits height_mm and mass_kg
SELECT 'fixture' AS subject,
       CASE WHEN count(*) > count(i.mass_kg) AND sum(i.mass_kg) <= m.value
                 AND max(i.max_z_mm) - min(i.min_z_mm) <= h.value THEN NULL
            ELSE max(i.max_z_mm) - min(i.min_z_mm) <= h.value
                 AND coalesce(sum(i.mass_kg), 0) <= m.value END AS ok,
       'the density of ' || (count(*) - count(i.mass_kg)) || ' parts is not known' AS reason,
       max(i.max_z_mm) - min(i.min_z_mm) AS height_mm,
       sum(i.mass_kg) AS mass_kg,
       h.value AS largest_mm,
       m.value AS largest_kg
FROM instances AS i
JOIN limits AS h ON h.name = 'height_mm'
JOIN limits AS m ON m.name = 'mass_kg'
HAVING count(*) > 0
