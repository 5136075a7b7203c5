// Files that pages save. Firefox's driver does not report them: they are found in their folder.

import { mkdirSync, readFileSync, readdirSync, rmSync, statSync } from "node:fs";
import { join } from "node:path";
import { eventually } from "./browser.mjs";
import { downloadFolder, inFirefox, outputFolder } from "./environment.mjs";

const timeoutMs = 130_000;
process.on("exit", () => rmSync(downloadFolder, { recursive: true, force: true }));

/** Complete files of the folder, with when they were written: a name may be used again. */
function saved() {
  mkdirSync(downloadFolder, { recursive: true });
  const names = readdirSync(downloadFolder);
  return names
    .filter((name) => !name.endsWith(".part") && !names.includes(`${name}.part`))
    .map((name) => ({ name, path: join(downloadFolder, name) }))
    .map((file) => ({ ...file, ...statSync(file.path) }))
    .filter(({ size }) => size > 0)
    .map(({ name, path, mtimeMs }) => ({ name, path, key: `${name} ${mtimeMs}` }));
}

/** Names of the files that `page` saves from now on. */
export function watchDownloads(page) {
  const before = new Set(saved().map(({ key }) => key));
  const names = [];
  page.on("download", (file) => names.push(file.suggestedFilename()));
  return () =>
    inFirefox ? saved().flatMap(({ name, key }) => (before.has(key) ? [] : [name])) : names;
}

/** The file that the page saves after `action`. */
export async function downloaded(page, action) {
  if (inFirefox) {
    const before = new Set(saved().map(({ key }) => key));
    await action();
    const file = await eventually(
      () => saved().find(({ key }) => !before.has(key)),
      "a saved file",
      timeoutMs,
    );
    return { name: file.name, path: file.path, bytes: readFileSync(file.path) };
  }
  const download = page.waitForEvent("download", { timeout: timeoutMs });
  await action();
  const file = await download;
  const path = join(outputFolder, file.suggestedFilename());
  await file.saveAs(path);
  return { name: file.suggestedFilename(), path, bytes: readFileSync(path) };
}
