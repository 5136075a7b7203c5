// The panel: every generated control changes its own setting, and shows what others change.

import assert from "node:assert/strict";
import {
  eventually,
  openTab,
  pictureScreenshot,
  reveal,
  screenshot,
  settle,
  unfoldAll,
} from "./harness/browser.mjs";
import { difference, statistics, thumbnail } from "./harness/pictures.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({
  // Cheap to draw and soon at rest: this file works through every setting.
  scene: "furnace",
  samples: 4,
  view: { viewport: { width: 800, height: 640 } },
  prepare: unfoldAll,
});

async function lookAt(page, name) {
  return thumbnail(page, await pictureScreenshot(page, name));
}

/** Every leaf of the schema with its dotted path. */
function leaves(schema, prefix = "") {
  return Object.entries(schema.properties ?? {}).flatMap(([name, node]) =>
    node.properties ? leaves(node, `${prefix}${name}.`) : [{ path: prefix + name, node }],
  );
}

const rowOf = (page, path) => page.locator(`[data-path="${path}"]`);

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

stage.test("there is a control for every setting of the schema", async () => {
  const { page } = await stage.sharedViewer();
  const shown = await page
    .locator("[data-path]")
    .evaluateAll((rows) => rows.map((row) => row.dataset.path));
  const expected = leaves(await stage.server.call("settings.schema"))
    .map(({ path }) => path)
    .filter((path) => path !== "view.buffer");
  assert.deepEqual([...shown].sort(), expected.sort());
});

stage.test("each control patches its setting, is marked, and resets", async () => {
  const { page } = await stage.sharedViewer();
  const worked = new Set();
  for (const { path, node } of leaves(await stage.server.call("settings.schema"))) {
    const row = rowOf(page, path);
    if ((await row.count()) === 0) continue;
    const kind = (await row.getAttribute("class")).match(/row-(\w+)/)[1];
    if (!workers[kind]) continue;
    await reveal(row);
    const given = path === "accumulation.max_samples" ? stage.samples : node.default;
    assert.deepEqual(await stage.server.setting(path), given, `${path} before`);
    await workers[kind](row);
    await eventually(
      async () => (await stage.server.setting(path)) !== given,
      `a change of ${path} on the server`,
    );
    await eventually(async () => (await row.getAttribute("class")).includes("changed"), "a mark");
    await row.locator(".reset").click();
    await eventually(
      async () => (await stage.server.setting(path)) === node.default,
      `a reset of ${path} on the server`,
    );
    if (given !== node.default) {
      // Pictures must come to rest, or the page has no machine left to work with.
      await stage.server.call("settings.patch", { patch: { accumulation: { max_samples: given } } });
    }
    worked.add(kind);
  }
  for (const kind of ["toggle", "slider", "choice"]) {
    assert.ok(worked.has(kind), `no ${kind} was tried`);
  }
});

stage.test("a typed value arrives and brightens the picture", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const before = statistics(await lookAt(page, "exposure_before")).mean;
  await reveal(rowOf(page, "exposure.compensation"));
  const entry = rowOf(page, "exposure.compensation").locator("input.number");
  await entry.fill("1.5");
  await entry.press("Enter");
  await eventually(async () => (await stage.server.setting("exposure.compensation")) === 1.5, "1.5");
  await eventually(
    async () => statistics(await lookAt(page, "exposure_after")).mean > before + 0.03,
    "a brighter picture",
  );
  await screenshot(page, "panel_changed");
  await rowOf(page, "exposure.compensation").locator(".reset").click();
  await eventually(async () => (await stage.server.setting("exposure.compensation")) === 0, "a reset");
});

stage.test("undo and redo go back and forth, by button and by key", async () => {
  const { page } = await stage.sharedViewer();
  const value = () => stage.server.setting("tone_map.curve");
  await reveal(rowOf(page, "tone_map.curve"));
  await rowOf(page, "tone_map.curve").locator("select").selectOption("agx");
  await eventually(async () => (await value()) === "agx", "the change");
  await openTab(page, "settings");
  await page.getByRole("button", { name: "Undo" }).click();
  await eventually(async () => (await value()) === "neutral", "the step back");
  await page.keyboard.press("Control+Shift+Z");
  await eventually(async () => (await value()) === "agx", "the step forth");
  await page.keyboard.press("Control+Z");
  await eventually(async () => (await value()) === "neutral", "the step back by key");
});

stage.test("the search finds settings by what they do and folds back afterwards", async () => {
  const { page } = await stage.sharedViewer();
  const rows = () => page.locator('[data-tab="settings"] .row:visible').count();
  const all = await rows();
  await page.getByRole("searchbox", { name: "Search settings" }).fill("ghosts");
  const found = await rows();
  assert.ok(found > 0 && found < all / 2, `${found} of ${all}`);
  await screenshot(page, "search");
  await page.getByRole("searchbox", { name: "Search settings" }).fill("");
  assert.equal(await rows(), all);
});

stage.test("a preset of the ladder is chosen and marked until something of it changes", async () => {
  const { page } = await stage.sharedViewer();
  const rung = page.getByRole("button", { name: "SVGF" });
  await rung.click();
  await eventually(async () => (await rung.getAttribute("aria-pressed")) === "true", "the mark");
  assert.equal(await stage.server.setting("shadow_blur.kernel"), "full");
  await stage.server.call("settings.patch", { patch: { shadow_blur: { iterations: 2 } } });
  await eventually(async () => (await rung.getAttribute("aria-pressed")) === "false", "no mark");
  await page.keyboard.press("Control+Z");
  await eventually(async () => (await stage.server.setting("shadow_blur.kernel")) === "separable", "undo");
});

stage.test("a change made elsewhere is shown", async () => {
  const { page } = await stage.sharedViewer();
  await stage.server.call("settings.patch", { patch: { exposure: { compensation: -2 } } });
  const entry = rowOf(page, "exposure.compensation").locator("input.number");
  await eventually(async () => (await entry.inputValue()) === "-2", "the control to follow");
  await stage.server.call("settings.patch", { patch: { exposure: null } });
  await eventually(async () => (await entry.inputValue()) === "0", "the control to follow");
});

stage.test("the buffer picker changes the picture", async () => {
  const { page } = await stage.sharedViewer();
  // The server's own capture waits for the newest state; the page may still show an older one.
  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  const before = await thumbnail(page, Buffer.from(capture.data, "base64"));
  await eventually(
    async () => difference(before, await lookAt(page, "buffer_output")) < 0.05,
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
  await eventually(async () => (await stage.server.setting("view.buffer")) === other, other);
  await eventually(
    async () => difference(before, await lookAt(page, "buffer_other")) > 0.03,
    `a picture of ${other}`,
  );
  await picker.selectOption("output");
  await eventually(
    async () => difference(before, await lookAt(page, "buffer_back")) < 0.05,
    "the finished picture again",
    60_000,
  );
});

stage.test("the scene picker loads another scene and shows a refusal in words", async () => {
  const { page } = await stage.sharedViewer();
  const { scenes, current } = await stage.server.call("scene.list");
  const other = scenes.find(({ name }) => name !== current);
  assert.ok(other, "the scene folder holds only one scene");
  await openTab(page, "scene");
  const picker = page.locator("select[name=scene]");
  await picker.selectOption(other.name);
  await eventually(
    async () => (await stage.server.call("scene.list")).current === other.name,
    `loading ${other.name}`,
    120_000,
  );
  await page.waitForFunction(() => document.querySelector("#notice").hidden);
  await eventually(async () => !(await picker.isDisabled()), "the picker to be free again");
  assert.equal(await picker.inputValue(), other.name);
  await settle(page, stage.server);
  await screenshot(page, "other_scene");

  await page.evaluate(() => {
    const select = document.querySelector("select[name=scene]");
    select.append(new Option("missing.glb", "missing.glb"));
  });
  await picker.selectOption("missing.glb");
  const toast = page.locator(".toast-text");
  await toast.waitFor({ timeout: 30_000 });
  assert.ok((await toast.innerText()).length > 8);
  assert.equal((await stage.server.call("scene.list")).current, other.name);
  await screenshot(page, "refused_scene");
});
