// Checks GLB files with the Khronos validator: no errors, no warnings.
// usage: node validate_gltf.mjs FOLDER EXPECTED_COUNT
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import validator from "gltf-validator";

const [folder, expected] = process.argv.slice(2);
const files = readdirSync(folder).filter((name) => name.endsWith(".glb")).sort();
let failed = false;
for (const name of files) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(join(folder, name))));
  const { numErrors, numWarnings, messages } = report.issues;
  console.log(`${name}: ${numErrors} errors, ${numWarnings} warnings`);
  for (const message of messages.filter((m) => m.severity <= 1)) {
    console.log(`  ${message.code} ${message.pointer}: ${message.message}`);
  }
  failed ||= numErrors + numWarnings > 0;
}
if (files.length !== Number(expected)) {
  console.log(`${files.length} scenes in ${folder}, expected ${expected}`);
  failed = true;
}
process.exit(failed ? 1 : 0);
