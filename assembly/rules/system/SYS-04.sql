-- id: SYS-04
-- severity: warning
-- title: There are as many of each element in the shop as the fixture takes
-- message: {subject}: {count} are placed, {stock} are there
-- reference: stated by `design ELEMENT stock`; elements without it are bought
-- each: bom.element
SELECT b.element AS subject, b.count <= s.value AS ok, b.count, s.value AS stock
FROM bom AS b
JOIN stated AS s ON s.subject = b.element AND s.quantity = 'stock'
