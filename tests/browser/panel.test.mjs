// The panel: every generated control changes its setting and follows changes by other viewers.

import assert from "node:assert/strict";
import {
  eventually,
  openTab,
  viewScreenshot,
  reveal,
  screenshot,
  settle,
  unfoldAll,
} from "./harness/browser.mjs";
import { difference, statistics, thumbnail } from "./harness/images.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({
  // Renders fast and converges soon: this file changes every setting.
  scene: "furnace",
  samples: 4,
  view: { viewport: { width: 800, height: 640 } },
  prepare: unfoldAll,
});

async function viewImage(page, name) {
  return thumbnail(page, await viewScreenshot(page, name));
}

/** Every leaf of the schema with its dotted path. */
function leaves(schema, prefix = "") {
  return Object.entries(schema.properties ?? {}).flatMap(([name, node]) =>
    node.properties ? leaves(node, `${prefix}${name}.`) : [{ path: prefix + name, node }],
  );
}

const rowOf = (page, path) => page.locator(`[data-path="${path}"]`);

/** Operates the control of one row as a user does, by its kind. */
const operate = {
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

/** The same by events in the page, which takes less time. */
function operateInPage(page, path) {
  return page.evaluate((name) => {
    const row = document.querySelector(`[data-path="${name}"]`);
    const control =
      row.querySelector("input[type=range]") ?? row.querySelector("select, input");
    const tell = (event) => control.dispatchEvent(event);
    if (row.matches(".row-toggle")) {
      control.click();
    } else if (row.matches(".row-choice")) {
      control.selectedIndex = (control.selectedIndex + 1) % control.options.length;
      tell(new Event("change", { bubbles: true }));
    } else if (row.matches(".row-slider")) {
      const key = Number(control.value) > 900 ? "ArrowLeft" : "ArrowRight";
      for (let i = 0; i < 3; i += 1) tell(new KeyboardEvent("keydown", { key, bubbles: true }));
    } else {
      control.value = String(Number(control.value) + 1);
      tell(new Event("change", { bubbles: true }));
    }
  }, path);
}

/** Resets a setting in the page once its row is marked as changed; false before. */
function resetInPage(page, path) {
  return page.evaluate((name) => {
    const row = document.querySelector(`[data-path="${name}"]`);
    const marked = row.matches(".changed");
    if (marked) row.querySelector(".reset").click();
    return marked;
  }, path);
}

stage.test("every setting of the schema has a control", async () => {
  const { page } = await stage.sharedViewer();
  const shown = await page
    .locator("[data-path]")
    .evaluateAll((rows) => rows.map((row) => row.dataset.path));
  const expected = leaves(await stage.server.call("settings.schema"))
    .map(({ path }) => path)
    .filter((path) => path !== "view.buffer");
  assert.deepEqual([...shown].sort(), expected.sort());
});

stage.test("every control patches its setting, is marked as changed, and resets", async () => {
  const { page } = await stage.sharedViewer();
  // In lockstep nothing is rendered, which would take the CPU time that the page needs.
  await stage.server.call("frame.step", { frames: 0, dt: 0 });
  const kinds = await page
    .locator("[data-path]")
    .evaluateAll((rows) =>
      rows.map((row) => [row.dataset.path, /row-(\w+)/.exec(row.className)[1]]),
    );
  const kindOf = new Map(kinds);
  const operated = new Set();
  for (const { path, node } of leaves(await stage.server.call("settings.schema"))) {
    const kind = kindOf.get(path);
    if (!operate[kind]) continue;
    const initial = stage.settings[path] ?? node.default;
    assert.deepEqual(await stage.server.setting(path), initial, `${path} before`);
    const asUser = !operated.has(kind);
    const row = rowOf(page, path);
    if (asUser) {
      await reveal(row);
      await operate[kind](row);
    } else {
      await operateInPage(page, path);
    }
    await eventually(
      async () => (await stage.server.setting(path)) !== initial,
      `a change of ${path} on the server`,
    );
    if (asUser) {
      await page.locator(`[data-path="${path}"].changed`).waitFor();
      await row.locator(".reset").click();
    } else {
      await eventually(() => resetInPage(page, path), `a mark of ${path}`);
    }
    await eventually(
      async () => (await stage.server.setting(path)) === node.default,
      `a reset of ${path} on the server`,
    );
    operated.add(kind);
  }
  for (const kind of ["toggle", "slider", "choice"]) {
    assert.ok(operated.has(kind), `no ${kind} was tested`);
  }
  await stage.server.call("settings.patch", {
    patch: { accumulation: { max_samples: stage.samples } },
  });
  await stage.server.call("frame.run");
});

stage.test("a typed exposure value brightens the frame", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const before = statistics(await viewImage(page, "exposure_before")).mean;
  await reveal(rowOf(page, "exposure.compensation"));
  const entry = rowOf(page, "exposure.compensation").locator("input.number");
  await entry.fill("1.5");
  await entry.press("Enter");
  await eventually(
    async () => (await stage.server.setting("exposure.compensation")) === 1.5,
    "1.5",
  );
  await eventually(
    async () => statistics(await viewImage(page, "exposure_after")).mean > before + 0.03,
    "a brighter frame",
  );
  await screenshot(page, "panel_changed");
  await rowOf(page, "exposure.compensation").locator(".reset").click();
  await eventually(
    async () => (await stage.server.setting("exposure.compensation")) === 0,
    "a reset",
  );
});

stage.test("undo and redo work by button and by key", async () => {
  const { page } = await stage.sharedViewer();
  const value = () => stage.server.setting("tone_map.curve");
  await reveal(rowOf(page, "tone_map.curve"));
  await rowOf(page, "tone_map.curve").locator("select").selectOption("agx");
  await eventually(async () => (await value()) === "agx", "the change");
  await openTab(page, "settings");
  await page.getByRole("button", { name: "Undo" }).click();
  await eventually(async () => (await value()) === "neutral", "undo");
  await page.keyboard.press("Control+Shift+Z");
  await eventually(async () => (await value()) === "agx", "redo");
  await page.keyboard.press("Control+Z");
  await eventually(async () => (await value()) === "neutral", "undo by key");
});

stage.test("the search finds settings by description and restores the sections", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "settings");
  const rows = () => page.locator('[data-tab="settings"] .row:visible').count();
  const all = await rows();
  await page.getByRole("searchbox", { name: "Search settings" }).fill("ghost");
  const found = await rows();
  assert.ok(found > 0 && found < all / 2, `${found} of ${all}`);
  await screenshot(page, "search");
  await page.getByRole("searchbox", { name: "Search settings" }).fill("");
  assert.equal(await rows(), all);
});

stage.test("the search finds controls of other tabs and leads to them", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "settings");
  const search = page.getByRole("searchbox", { name: "Search settings" });
  await search.fill("exposure (ev)");
  // An undo button may tell of the exposure, too.
  const found = page.locator(".found", { hasText: /^Exposure \(EV\)/ });
  await screenshot(page, "search_elsewhere");
  await found.press("Enter");
  const entry = rowOf(page, "exposure.compensation").locator("input.number");
  await eventually(() => entry.evaluate((node) => node === document.activeElement), "the focus");
  await openTab(page, "settings");
  for (const [words, label] of [
    ["metallic", "Metallic"],
    ["quality", "Quality"],
    ["camera", "Camera"],
  ]) {
    await search.fill(words);
    await page.locator(".found", { hasText: label }).first().waitFor();
  }
  await search.fill("no such control");
  await page.getByText("No matching settings.").waitFor();
  await search.fill("");
  assert.equal(await page.locator(".found").count(), 0);
});

stage.test("the search finds every control by its name", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "settings");
  const { names, missing } = await page.evaluate(() => {
    const search = document.querySelector("input[name=search]");
    const nothing = document.querySelector(".no-results");
    const isOffered = (node) => {
      const hidden = node.closest("[hidden]");
      return !hidden || hidden.matches("[data-tab], [role=menu]");
    };
    const nameOf = (node) =>
      node.closest(".row")?.querySelector("label, .row-label")?.textContent ??
      node.getAttribute("aria-label") ??
      node.labels?.[0]?.textContent ??
      node.textContent;
    const controls = document.querySelectorAll(
      ":is(#panel, #transport, #top-left) :is(button, select, input:not([type=file], [type=search]))",
    );
    const offered = [...controls].filter(
      (node) => isOffered(node) && !node.matches("[role=tab], .reset"),
    );
    const all = new Set(offered.map((node) => nameOf(node).trim()));
    const finds = (name) => {
      search.value = name;
      search.dispatchEvent(new Event("input"));
      return nothing.hidden;
    };
    const lost = [...all].filter((name) => !finds(name));
    finds("");
    return { names: [...all], missing: lost };
  });
  assert.ok(names.length > 100 && names.includes("Exposure (EV)"), names.join(", "));
  assert.deepEqual(missing, []);
  const search = page.getByRole("searchbox", { name: "Search settings" });
  await search.fill("save image");
  await page.locator(".found", { hasText: "Save image" }).press("Enter");
  const item = page.getByRole("menuitem", { name: "Save image" });
  await eventually(() => item.evaluate((node) => node === document.activeElement), "the focus");
  await page.keyboard.press("Escape");
  await search.fill("");
});

stage.test("the preset in effect is marked from the start", async () => {
  const { page } = await stage.watch();
  await openTab(page, "settings");
  const best = page.getByRole("button", { name: "Best", exact: true });
  await eventually(async () => (await best.getAttribute("aria-pressed")) === "true", "the mark");
});

stage.test("a preset is applied and marked until one of its settings changes", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "settings");
  const preset = page.getByRole("button", { name: "SVGF", exact: true });
  await preset.click();
  await eventually(async () => (await preset.getAttribute("aria-pressed")) === "true", "the mark");
  assert.equal(await stage.server.setting("shadow_blur.kernel"), "full");
  await stage.server.call("settings.patch", { patch: { shadow_blur: { iterations: 2 } } });
  await eventually(async () => (await preset.getAttribute("aria-pressed")) === "false", "no mark");
  await page.keyboard.press("Control+Z");
  await eventually(
    async () => (await stage.server.setting("shadow_blur.kernel")) === "separable",
    "undo",
  );
});

stage.test("a change by another viewer is shown", async () => {
  const { page } = await stage.sharedViewer();
  await stage.server.call("settings.patch", { patch: { exposure: { compensation: -2 } } });
  const entry = rowOf(page, "exposure.compensation").locator("input.number");
  await eventually(async () => (await entry.inputValue()) === "-2", "the control to follow");
  await stage.server.call("settings.patch", { patch: { exposure: null } });
  await eventually(async () => (await entry.inputValue()) === "0", "the control to follow");
});

stage.test("the buffer picker changes the frame", async () => {
  const { page } = await stage.sharedViewer();
  // A capture waits for the newest state; the page may still show an older frame.
  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  const before = await thumbnail(page, Buffer.from(capture.data, "base64"));
  await eventually(
    async () => difference(before, await viewImage(page, "buffer_output")) < 0.05,
    "the newest frame",
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
    async () => difference(before, await viewImage(page, "buffer_other")) > 0.03,
    `the buffer ${other}`,
  );
  await picker.selectOption("output");
  await eventually(
    async () => difference(before, await viewImage(page, "buffer_back")) < 0.05,
    "the output again",
    60_000,
  );
});

stage.test("the scene picker loads another scene and shows errors", async () => {
  const { page } = await stage.sharedViewer();
  const { scenes, current } = await stage.server.call("scene.list");
  const other = scenes.find(({ name }) => name !== current);
  assert.ok(other, "the scene folder has only one scene");
  await openTab(page, "scene");
  const picker = page.locator("select[name=scene]");
  await picker.selectOption(other.name);
  await eventually(
    async () => (await stage.server.call("scene.list")).current === other.name,
    `loading ${other.name}`,
    120_000,
  );
  await page.waitForFunction(() => document.querySelector("#notice").hidden);
  await eventually(async () => !(await picker.isDisabled()), "the picker to be enabled");
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
  await screenshot(page, "scene_error");
});
