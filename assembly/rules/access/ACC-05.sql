-- id: ACC-05
-- severity: error
-- title: The fixture can be put together
-- message: {subject} comes in on no straight way; {blocked_by} is in the first that was tried
-- reference: an order of assembly by directions of insertion, each way swept; looked for where limit
--     assembly_order is 1
SELECT instance AS subject, free AS ok, step, coalesce(blocked_by, 'nothing') AS blocked_by
FROM assembly_order
