// node check_sarif.mjs FILE...: exit code 1 and the reasons where a SARIF log does not hold against
// the schema of SARIF 2.1.0, as the package @microsoft/jest-sarif has it.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import Ajv from 'ajv';

const require = createRequire(import.meta.url);
const read = (file) => JSON.parse(readFileSync(file, 'utf8'));
const ajv = new Ajv({ schemaId: 'auto', allErrors: true });
ajv.addMetaSchema(require('ajv/lib/refs/json-schema-draft-04.json'));
const validate = ajv.compile(
  read(require.resolve('@microsoft/jest-sarif/lib/schemas/sarif-2.1.0-rtm.5.json')));

for (const file of process.argv.slice(2)) {
  if (validate(read(file))) continue;
  process.exitCode = 1;
  for (const error of validate.errors) console.error(`${file}${error.dataPath}: ${error.message}`);
}
