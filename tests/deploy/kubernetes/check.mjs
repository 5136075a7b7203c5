// Checks Kubernetes objects, a JSON list on standard input: values against the schema of the API, and
// members against its types, which reject unknown ones.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(import.meta.url);
const objects = JSON.parse(readFileSync(0, "utf8"));
const here = import.meta.dirname ?? new URL(".", import.meta.url).pathname;

let failures = 0;
const lines = [];
objects.forEach((object, index) => {
  const module = `kubernetes-models/${object.apiVersion}`;
  const label = `${object.kind} ${object.metadata?.name}`;
  const Model = require(module)[object.kind];
  if (!Model) {
    console.error(`${label}: ${object.apiVersion} knows no such kind`);
    failures += 1;
    return;
  }
  try {
    new Model(object).validate();
  } catch (error) {
    console.error(`${label}: ${error.message}`);
    failures += 1;
  }
  lines.push(`import { I${object.kind} as Type${index} } from "${module}";`,
             `export const object${index}: Type${index} = ${JSON.stringify(object, null, 2)};`);
});

const folder = mkdtempSync(join(here, "types-"));
try {
  writeFileSync(join(folder, "objects.ts"), lines.join("\n"));
  execFileSync(join(here, "node_modules/.bin/tsc"),
               ["--noEmit", "--strict", "--skipLibCheck", "--module", "nodenext",
                "--moduleResolution", "nodenext", join(folder, "objects.ts")], { stdio: "inherit" });
} catch {
  failures += 1;
} finally {
  rmSync(folder, { recursive: true });
}
console.log(`${objects.length} objects, ${failures} failures`);
process.exit(failures ? 1 : 0);
