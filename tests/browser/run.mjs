// Runs every *.test.mjs, or with --long those of the folder long, one after another: they share the
// CPU with a software renderer. Exits with 77, which ctest reports as "skipped", without a browser or
// server.

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
if (!process.env.HELIOGRAPH_BINARY) skip("HELIOGRAPH_BINARY is not set");
if (!process.env.HELIOGRAPH_SCENE_ROOT) skip("HELIOGRAPH_SCENE_ROOT is not set");

const long = process.argv.includes("--long");
const filters = process.argv.slice(2).filter((argument) => argument !== "--long");
const folder = long ? join(here, "long") : here;
const files = readdirSync(folder)
  .filter((name) => name.endsWith(long ? ".mjs" : ".test.mjs"))
  .filter((name) => filters.length === 0 || filters.some((part) => name.includes(part)));
let failed = files.length === 0;
for (const name of files) {
  const run = spawnSync(process.execPath, ["--test", join(folder, name)], { stdio: "inherit" });
  failed ||= run.status !== 0;
}
process.exit(failed ? 1 : 0);
