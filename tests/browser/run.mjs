// Runs every *.test.mjs here and in tools, or with --long those of the folder long. Files run in two
// slots side by side: while the page of one waits, the server of the other renders. Each slot has one
// browser, so that files share neither its clipboard nor the time that it takes to start. Long ones
// measure, and run alone. With --firefox they run in Firefox, one browser for each file. Exits with
// 77, which ctest reports as "skipped", without a browser or server.

import { spawn } from "node:child_process";
import { existsSync, readdirSync, statSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { startBrowserServer } from "./harness/browser.mjs";
import { chromiumPath, firefoxPath } from "./harness/environment.mjs";

function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}

/** Runs a file to its end; gives whether it passed. Its output comes in one piece. */
function run(path, browser) {
  const began = performance.now();
  const env = { ...process.env, HELIOGRAPH_TEST_BROWSER: browser };
  const test = spawn(process.execPath, ["--test", path], { env, stdio: ["ignore", "pipe", "pipe"] });
  const output = [];
  test.stdout.on("data", (chunk) => output.push(chunk));
  test.stderr.on("data", (chunk) => output.push(chunk));
  return new Promise((resolve) => {
    test.on("close", (status) => {
      process.stdout.write(Buffer.concat(output));
      const seconds = ((performance.now() - began) / 1000).toFixed(1);
      console.log(`# ${path} took ${seconds} s\n`);
      resolve(status === 0);
    });
  });
}

const here = dirname(fileURLToPath(import.meta.url));
const [long, inFirefox] = ["--long", "--firefox"].map((option) => process.argv.includes(option));
if (inFirefox && !firefoxPath) skip("Firefox is not installed");
if (!inFirefox && !existsSync(chromiumPath)) skip(`no Chromium at ${chromiumPath}`);
if (!process.env.HELIOGRAPH_BINARY) skip("HELIOGRAPH_BINARY is not set");
if (!process.env.HELIOGRAPH_SCENE_ROOT) skip("HELIOGRAPH_SCENE_ROOT is not set");

const filters = process.argv.slice(2).filter((argument) => !argument.startsWith("--"));
const folders = long ? [join(here, "long")] : [here, join(here, "tools")];
const files = folders
  .flatMap((folder) => readdirSync(folder).map((name) => join(folder, name)))
  .filter((path) => path.endsWith(long ? ".mjs" : ".test.mjs"))
  .filter((path) => filters.length === 0 || filters.some((part) => basename(path).includes(part)))
  // Large files first, so that no slot is left with one at the end.
  .sort((a, b) => statSync(b).size - statSync(a).size);
let failed = files.length === 0;

async function work() {
  const browser = inFirefox ? null : await startBrowserServer();
  for (let path = files.shift(); path; path = files.shift()) {
    if (!(await run(path, browser?.wsEndpoint() ?? "firefox"))) failed = true;
  }
  await browser?.close();
}

await Promise.all(Array.from({ length: long ? 1 : 2 }, work));
process.exit(failed ? 1 : 0);
