// Bundles the client into dist/ (or --out DIR) and refuses to let it grow beyond its budget.

import { copyFileSync, mkdirSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import * as esbuild from "esbuild";

const gzippedBudget = 150_000;
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

const options = {
  absWorkingDir: here,
  entryPoints: {
    app: "src/app/main.ts",
    worker: "src/stream/worker.ts",
    similarity_worker: "src/compare/similarity_worker.ts",
    style: "src/style/index.css",
  },
  outdir: folder,
  bundle: true,
  format: "iife",
  target: ["es2021", "chrome100", "firefox102", "safari15"],
  minify: !watching,
  sourcemap: watching ? "linked" : false,
  logLevel: "warning",
};
for (const name of ["index.html", "icon.svg"]) {
  copyFileSync(join(here, "src/app", name), join(folder, name));
}

if (watching) {
  await (await esbuild.context(options)).watch();
} else {
  await esbuild.build(options);
  const sizes = gzippedSizes(folder);
  const total = sizes.reduce((sum, { bytes }) => sum + bytes, 0);
  for (const { name, bytes } of sizes) console.log(`${name}: ${bytes} bytes gzipped`);
  console.log(`total: ${total} of ${gzippedBudget} bytes gzipped`);
  if (total > gzippedBudget) {
    console.error("The bundle is larger than its budget.");
    process.exitCode = 1;
  }
}
