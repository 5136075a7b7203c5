// Checks GLB files with the Khronos validator: no errors, no warnings.
// usage: npm install gltf-validator && node validate_gltf.mjs FILE.glb...
import { readFileSync } from "node:fs";
import validator from "gltf-validator";

let failed = false;
for (const path of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)));
  const { numErrors, numWarnings, messages } = report.issues;
  console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings`);
  for (const message of messages.filter((m) => m.severity <= 1)) {
    console.log(`  ${message.code} ${message.pointer}: ${message.message}`);
  }
  failed ||= numErrors + numWarnings > 0;
}
process.exit(failed ? 1 : 0);
