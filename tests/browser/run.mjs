// Runs every *.test.mjs in turn, or with --long every *.long.mjs: they share the machine's few cores with a software renderer.
// Ends with 77, which test drivers read as "skipped", where a browser or a server is missing.

import { spawnSync } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromiumPath } from "./harness/environment.mjs";

function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}

const here = dirname(fileURLToPath(import.meta.url));
if (!existsSync(chromiumPath)) skip(`no Chromium at ${chromiumPath}`);
if (!process.env.HELIOGRAPH_BINARY) skip("HELIOGRAPH_BINARY does not name the server");
if (!process.env.HELIOGRAPH_SCENE_ROOT) skip("HELIOGRAPH_SCENE_ROOT does not name a scene folder");

const long = process.argv.includes("--long");
const wanted = process.argv.slice(2).filter((argument) => argument !== "--long");
const files = readdirSync(here)
  .filter((name) => name.endsWith(long ? ".long.mjs" : ".test.mjs"))
  .filter((name) => wanted.length === 0 || wanted.some((part) => name.includes(part)));
let failed = files.length === 0;
for (const name of files) {
  const run = spawnSync(process.execPath, ["--test", join(here, name)], { stdio: "inherit" });
  failed ||= run.status !== 0;
}
process.exit(failed ? 1 : 0);
