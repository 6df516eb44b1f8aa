-- id: FST-02
-- severity: error
-- title: A part with mates cannot move: mates or joints take all its freedoms
-- message: {subject} can slide along {slides} and turn about {turns} axes, and no joint holds it
-- reference: Grubler: six freedoms less what the mates take
-- each: freedoms.instance
SELECT f.instance AS subject,
       f.slides + f.turns = 0
         OR EXISTS (SELECT 1 FROM fastenings AS j WHERE j.instance = f.instance) AS ok,
       f.slides,
       f.turns
FROM freedoms AS f
JOIN instances AS i ON i.instance = f.instance
WHERE i.grounded = 0
  AND i.role <> 'workpiece'
