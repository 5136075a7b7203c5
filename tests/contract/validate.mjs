// Holds what `heliograph schema` prints to the OpenRPC meta-schema, every schema in it to JSON
// Schema 2020-12, and every example to the schemas beside it. Ends with 1 and says what is wrong.
//   validate.mjs path/to/heliograph

import { execFileSync } from "node:child_process";
import { createRequire } from "node:module";
import { strict as assert } from "node:assert";

const require = createRequire(import.meta.url);
const { default: openRpcSchema } = require("@open-rpc/meta-schema");
const { default: jsonSchemaSchema } = require("@json-schema-tools/meta-schema");
const { default: Ajv } = require("ajv");
const { default: Ajv2020 } = require("ajv/dist/2020.js");

const problems = [];

// Both are drafts of 2019 in all but their name, which ajv would have to know.
function asDraft7({ $schema, ...schema }) {
  return schema;
}

function openRpcValidator() {
  const ajv = new Ajv({ strict: false, validateFormats: false, validateSchema: false });
  ajv.addSchema(asDraft7(jsonSchemaSchema), "https://meta.json-schema.tools");
  return ajv.compile(asDraft7(openRpcSchema));
}

// Our own keywords beside the standard's; anything else that is unknown is a mistake.
const ours = ["x-unit", "x-resets", "x-order"];
const ajv = new Ajv2020({ strict: true, allowUnionTypes: true, allErrors: true });
ours.forEach((keyword) => ajv.addKeyword(keyword));
// A note for editors; the pattern beside it says what is valid.
ajv.addFormat("color", true);

function check(where, schema, value) {
  let validate;
  try {
    validate = ajv.compile(schema);
  } catch (error) {
    problems.push(`${where}: ${error.message}`);
    return;
  }
  if (value !== undefined && !validate(value)) {
    problems.push(`${where}: ${ajv.errorsText(validate.errors)}`);
  }
}

const text = execFileSync(process.argv[2], ["schema"], { maxBuffer: 1 << 26 });
const { openrpc: document, settings } = JSON.parse(text);

const validate = openRpcValidator();
if (!validate(document)) {
  problems.push(...validate.errors.map((error) => `${error.instancePath} ${error.message}`));
}
// The validator itself must be able to say no.
assert(!validate({ ...document, methods: [{ name: 5 }] }));
assert(!validate({ ...document, openrpc: "0.1" }));

for (const method of document.methods) {
  const example = method.examples[0];
  const given = Object.fromEntries(example.params.map(({ name, value }) => [name, value]));
  for (const { name, required, schema } of method.params) {
    if (required && !(name in given)) problems.push(`${method.name}: no example of ${name}`);
    check(`${method.name} ${name}`, schema, given[name]);
    delete given[name];
  }
  for (const name of Object.keys(given)) problems.push(`${method.name}: what is ${name}?`);
  check(`${method.name} result`, method.result.schema, example.result.value);
}
for (const { name, params } of document["x-notifications"]) {
  for (const param of params) check(`${name} ${param.name}`, param.schema);
}
check("settings", settings);

problems.forEach((problem) => console.error(problem));
console.log(`${document.methods.length} methods, ${problems.length} problems`);
process.exit(problems.length ? 1 : 0);
