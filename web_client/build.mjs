// Bundles the client into dist/ (or --out DIR) and refuses to let it grow beyond its budgets.

import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

/** Of what a browser loads before the first frame, and of everything else, in bytes. */
const budgets = { first: 120_000, "on demand": 60_000 };
const loadedFirst = new Set(["index.html", "app.js", "worker.js", "style.css", "icon.svg"]);
const here = dirname(fileURLToPath(import.meta.url));

function outputFolder() {
  const index = process.argv.indexOf("--out");
  if (index < 0) return join(here, "dist");
  const folder = process.argv[index + 1];
  if (!folder) throw new Error("--out needs a folder");
  return resolve(folder);
}

function gzippedSizes(folder) {
  return readdirSync(folder)
    .filter((name) => !name.endsWith(".map"))
    .map((name) => ({ name, bytes: gzipSync(readFileSync(join(folder, name))).length }));
}

const folder = outputFolder();
const watching = process.argv.includes("--watch");
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

// CMakeLists.txt reads them too, for builds without npm.
const options = readFileSync(join(here, "esbuild.options"), "utf8").split("\n").filter(Boolean);
for (const name of ["index.html", "api.html", "jobs.html", "token.html", "icon.svg"]) {
  copyFileSync(join(here, "src/app", name), join(folder, name));
}

const mode = watching ? ["--sourcemap=linked", "--watch"] : ["--minify"];
const esbuild = join(here, "node_modules/.bin/esbuild");
const { status } = spawnSync(esbuild, [...options, ...mode, `--outdir=${folder}`], {
  cwd: here,
  stdio: "inherit",
});
if (status !== 0) {
  process.exitCode = 1;
} else if (!watching) {
  const sizes = gzippedSizes(folder);
  for (const { name, bytes } of sizes) console.log(`${name}: ${bytes} bytes gzipped`);
  for (const [part, budget] of Object.entries(budgets)) {
    const files = sizes.filter(({ name }) => loadedFirst.has(name) === (part === "first"));
    const total = files.reduce((sum, { bytes }) => sum + bytes, 0);
    console.log(`${part}: ${total} of ${budget} bytes gzipped`);
    if (total > budget) {
      console.error(`What is loaded ${part} is larger than its budget.`);
      process.exitCode = 1;
    }
  }
}
