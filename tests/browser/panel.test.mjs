// The panel: every generated control changes its own setting, and shows what others change.

import assert from "node:assert/strict";
import test, { after, before } from "node:test";
import {
  eventually,
  firstPicture,
  launchBrowser,
  openTab,
  openViewer,
  pictureScreenshot,
  reveal,
  screenshot,
  settle,
} from "./harness/browser.mjs";
import { difference, statistics, thumbnail } from "./harness/pictures.mjs";
import { startServer } from "./harness/server.mjs";

let server;
let browser;
let viewer;

before(async () => {
  server = await startServer();
  browser = await launchBrowser();
  viewer = await openViewer(browser, server.url, { viewport: { width: 960, height: 900 } });
  await firstPicture(viewer.page);
  await viewer.page.evaluate(() => {
    for (const fold of document.querySelectorAll(".section details")) fold.open = true;
  });
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

async function lookAt(name) {
  return thumbnail(viewer.page, await pictureScreenshot(viewer.page, name));
}

/** Every leaf of the schema with its dotted path. */
function leaves(schema, prefix = "") {
  return Object.entries(schema.properties ?? {}).flatMap(([name, node]) =>
    node.properties ? leaves(node, `${prefix}${name}.`) : [{ path: prefix + name, node }],
  );
}

const rowOf = (path) => viewer.page.locator(`[data-path="${path}"]`);

/** Works the control of one row like a person; each kind in its own way. */
const workers = {
  toggle: (row) => row.locator("input").click(),
  choice: async (row) => {
    const select = row.locator("select");
    const count = await select.locator("option").count();
    const index = await select.evaluate((node) => node.selectedIndex);
    await select.selectOption({ index: (index + 1) % count });
  },
  slider: async (row) => {
    const track = row.locator("input[type=range]");
    await track.focus();
    const atEnd = await track.evaluate((node) => Number(node.value) > 900);
    for (let i = 0; i < 3; i += 1) await track.press(atEnd ? "ArrowLeft" : "ArrowRight");
  },
  number: async (row) => {
    const input = row.locator("input");
    await input.fill(String(Number(await input.inputValue()) + 1));
    await input.press("Enter");
  },
};

test("there is a control for every setting of the schema", async () => {
  const shown = await viewer.page
    .locator("[data-path]")
    .evaluateAll((rows) => rows.map((row) => row.dataset.path));
  const expected = leaves(await server.call("settings.schema"))
    .map(({ path }) => path)
    .filter((path) => path !== "view.buffer");
  assert.deepEqual([...shown].sort(), expected.sort());
});

test("each control patches its setting, is marked, and resets", async () => {
  const worked = new Set();
  for (const { path, node } of leaves(await server.call("settings.schema"))) {
    const row = rowOf(path);
    if ((await row.count()) === 0) continue;
    const kind = (await row.getAttribute("class")).match(/row-(\w+)/)[1];
    if (!workers[kind]) continue;
    await reveal(row);
    assert.deepEqual(await server.setting(path), node.default, `${path} before`);
    await workers[kind](row);
    await eventually(
      async () => (await server.setting(path)) !== node.default,
      `a change of ${path} on the server`,
    );
    await eventually(async () => (await row.getAttribute("class")).includes("changed"), "a mark");
    await row.locator(".reset").click();
    await eventually(
      async () => (await server.setting(path)) === node.default,
      `a reset of ${path} on the server`,
    );
    worked.add(kind);
  }
  for (const kind of ["toggle", "slider", "choice"]) {
    assert.ok(worked.has(kind), `no ${kind} was tried`);
  }
});

test("a typed value arrives and brightens the picture", async () => {
  const { page } = viewer;
  await settle(page);
  const before = statistics(await lookAt("exposure_before")).mean;
  await reveal(rowOf("exposure.compensation"));
  const entry = rowOf("exposure.compensation").locator("input.number");
  await entry.fill("1.5");
  await entry.press("Enter");
  await eventually(async () => (await server.setting("exposure.compensation")) === 1.5, "1.5");
  await eventually(
    async () => statistics(await lookAt("exposure_after")).mean > before + 0.03,
    "a brighter picture",
  );
  await screenshot(page, "panel_changed");
  await rowOf("exposure.compensation").locator(".reset").click();
  await eventually(async () => (await server.setting("exposure.compensation")) === 0, "a reset");
});

test("undo and redo go back and forth, by button and by key", async () => {
  const { page } = viewer;
  const value = () => server.setting("tone_map.curve");
  await reveal(rowOf("tone_map.curve"));
  await rowOf("tone_map.curve").locator("select").selectOption("agx");
  await eventually(async () => (await value()) === "agx", "the change");
  await openTab(page, "settings");
  await page.getByRole("button", { name: "Undo" }).click();
  await eventually(async () => (await value()) === "neutral", "the step back");
  await page.keyboard.press("Control+Shift+Z");
  await eventually(async () => (await value()) === "agx", "the step forth");
  await page.keyboard.press("Control+Z");
  await eventually(async () => (await value()) === "neutral", "the step back by key");
});

test("the search finds settings by what they do and folds back afterwards", async () => {
  const { page } = viewer;
  const rows = () => page.locator('[data-tab="settings"] .row:visible').count();
  const all = await rows();
  await page.getByRole("searchbox", { name: "Search settings" }).fill("ghosts");
  const found = await rows();
  assert.ok(found > 0 && found < all / 2, `${found} of ${all}`);
  await screenshot(page, "search");
  await page.getByRole("searchbox", { name: "Search settings" }).fill("");
  assert.equal(await rows(), all);
});

test("a preset of the ladder is chosen and marked until something of it changes", async () => {
  const { page } = viewer;
  const rung = page.getByRole("button", { name: "SVGF" });
  await rung.click();
  await eventually(async () => (await rung.getAttribute("aria-pressed")) === "true", "the mark");
  assert.equal(await server.setting("shadow_blur.kernel"), "full");
  await server.call("settings.patch", { patch: { shadow_blur: { iterations: 2 } } });
  await eventually(async () => (await rung.getAttribute("aria-pressed")) === "false", "no mark");
  await page.keyboard.press("Control+Z");
  await eventually(async () => (await server.setting("shadow_blur.kernel")) === "separable", "undo");
});

test("a change made elsewhere is shown", async () => {
  await server.call("settings.patch", { patch: { exposure: { compensation: -2 } } });
  const entry = rowOf("exposure.compensation").locator("input.number");
  await eventually(async () => (await entry.inputValue()) === "-2", "the control to follow");
  await server.call("settings.patch", { patch: { exposure: null } });
  await eventually(async () => (await entry.inputValue()) === "0", "the control to follow");
});

test("the buffer picker changes the picture", async () => {
  const { page } = viewer;
  // The server's own capture waits for the newest state; the page may still show an older one.
  const capture = await server.call("frame.capture", { buffer: "output", format: "png" });
  const before = await thumbnail(page, Buffer.from(capture.data, "base64"));
  await eventually(
    async () => difference(before, await lookAt("buffer_output")) < 0.05,
    "the newest picture",
    60_000,
  );
  await openTab(page, "inspect");
  const picker = page.locator("select[name=buffer]");
  const names = await picker
    .locator("option")
    .evaluateAll((options) => options.map((option) => option.value));
  assert.equal(names[0], "output");
  const other = names.find((name) => name.includes("normal")) ?? names[1];
  await picker.selectOption(other);
  await eventually(async () => (await server.setting("view.buffer")) === other, other);
  await eventually(
    async () => difference(before, await lookAt("buffer_other")) > 0.03,
    `a picture of ${other}`,
  );
  await picker.selectOption("output");
  await eventually(
    async () => difference(before, await lookAt("buffer_back")) < 0.05,
    "the finished picture again",
    60_000,
  );
});

test("the scene picker loads another scene and shows a refusal in words", async () => {
  const { page } = viewer;
  const { scenes, current } = await server.call("scene.list");
  const other = scenes.find(({ name }) => name !== current);
  assert.ok(other, "the scene folder holds only one scene");
  await openTab(page, "scene");
  const picker = page.locator("select[name=scene]");
  await picker.selectOption(other.name);
  await eventually(
    async () => (await server.call("scene.list")).current === other.name,
    `loading ${other.name}`,
    120_000,
  );
  await page.waitForFunction(() => document.querySelector("#notice").hidden);
  await eventually(async () => !(await picker.isDisabled()), "the picker to be free again");
  assert.equal(await picker.inputValue(), other.name);
  await settle(page);
  await screenshot(page, "other_scene");

  await page.evaluate(() => {
    const select = document.querySelector("select[name=scene]");
    select.append(new Option("missing.glb", "missing.glb"));
  });
  await picker.selectOption("missing.glb");
  const toast = page.locator(".toast-text");
  await toast.waitFor({ timeout: 30_000 });
  assert.ok((await toast.innerText()).length > 8);
  assert.equal((await server.call("scene.list")).current, other.name);
  await screenshot(page, "refused_scene");
});

test("saving downloads a PNG of the session's picture", async () => {
  const { page } = viewer;
  const download = page.waitForEvent("download", { timeout: 130_000 });
  await page.getByRole("button", { name: "Save and share" }).click();
  await page.getByRole("menuitem", { name: "Save picture as PNG" }).click();
  assert.match((await download).suggestedFilename(), /\.png$/);
  await page.getByRole("button", { name: "Save and share" }).click();
  const exr = page.getByRole("menuitem", { name: "Save picture as EXR" });
  if (!(await exr.isVisible())) return; // a server that writes none
  const values = page.waitForEvent("download", { timeout: 130_000 });
  await exr.click();
  assert.match((await values).suggestedFilename(), /\.exr$/);
});

test("nothing was written to the console and no policy was violated", () => {
  assert.deepEqual(viewer.complaints, []);
});
