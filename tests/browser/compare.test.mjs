// Comparison of two sessions, side by side or overlaid.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import {
  distance,
  dragView,
  eventually,
  openTab,
  screenshot,
  settle,
  viewScreenshot,
} from "./harness/browser.mjs";
import { statistics, thumbnail } from "./harness/images.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({
  samples: 16,
  resolution: "half",
  view: { viewport: { width: 800, height: 450 } },
});

async function otherSession() {
  const { sessions } = await stage.server.call("session.list");
  return sessions.find(({ name }) => name !== "main");
}

stage.test("comparing a preset opens a second session that follows the camera", async () => {
  const { page } = await stage.watch();
  await openTab(page, "inspect");
  await page.locator("select[name=compare]").selectOption("preset:svgf");
  const divider = page.getByRole("slider", { name: "Divider between the two frames" });
  await divider.waitFor({ timeout: 60_000 });
  const { name } = await eventually(otherSession, "a second session");
  await eventually(async () => {
    const { settings } = await stage.server.call("settings.get", {}, name);
    return settings.shadow_blur.kernel === "full";
  }, "the preset in the second session");
  assert.equal(await stage.server.setting("shadow_blur.kernel"), "separable");

  await dragView(page, { x: 150, y: 250 }, { x: 260, y: 270 });
  await eventually(async () => {
    const here = await stage.server.call("camera.get");
    const there = await stage.server.call("camera.get", {}, name);
    return distance(here.eye, there.eye) < 1e-4 && here.name === null;
  }, "equal cameras");
  const similarity = await eventually(
    async () => {
      const text = await page.locator("[data-figure-of=similarity]").textContent();
      const figure = Number(/SSIM\) ([\d.]+)/.exec(text)?.[1]);
      // The first measurements compare frames before and after the move.
      return figure > 0.5 && figure;
    },
    "similar frames",
    60_000,
  );
  assert.ok(similarity <= 1, String(similarity));

  await divider.focus();
  await page.keyboard.press("Shift+ArrowLeft");
  assert.equal(await divider.getAttribute("aria-valuenow"), "40");
  const { x, y, width } = await divider.boundingBox();
  await page.mouse.move(x + width / 2, y + 100);
  await page.mouse.down();
  await page.mouse.move(240, y + 100, { steps: 4 });
  await page.mouse.up();
  assert.equal(await divider.getAttribute("aria-valuenow"), "30");
  await screenshot(page, "compare");

  await page.locator("select[name=compare]").selectOption("");
  await eventually(async () => !(await otherSession()), "the second session to end");
  assert.equal(await divider.isVisible(), false);
});

stage.test("the second session follows light, material, environment, size and scene", async () => {
  const { server } = stage;
  const { page } = await stage.watch();
  await openTab(page, "inspect");
  const select = page.locator("select[name=compare]");
  await select.selectOption("preset:svgf");
  const { name } = await eventually(otherSession, "a second session");
  const there = (method) => server.call(method, {}, name);
  const kernelOf = async (session) =>
    (await server.call("settings.get", {}, session)).settings.shadow_blur.kernel;
  await eventually(
    async () => (await kernelOf(name)) === "full",
    "the preset in the second session",
  );

  const [{ name: light, intensity }] = (await server.call("lights.list")).lights;
  const [{ name: material }] = (await server.call("materials.list")).materials;
  const lightThere = async () => (await there("lights.list")).lights[0];
  const materialThere = async () => (await there("materials.list")).materials[0];
  await server.call("lights.patch", { light, patch: { intensity: 1.5, enabled: false } });
  await server.call("materials.patch", { material, patch: { roughness: 0.75 } });
  await server.call("environment.set", { name: "white" });
  await server.call("settings.patch", { patch: { exposure: { compensation: 1.25 } } });
  await page.setViewportSize({ width: 640, height: 360 });
  await eventually(async () => {
    const sun = await lightThere();
    return sun.intensity === 1.5 && !sun.enabled;
  }, "the light in the second session");
  await eventually(async () => (await materialThere()).roughness === 0.75, "the material");
  await eventually(
    async () => (await there("environment.list")).current === "white",
    "the environment",
  );
  await eventually(
    async () => (await there("settings.get")).settings.exposure.compensation === 1.25,
    "the exposure",
  );
  await eventually(async () => (await there("session.info")).width === 320, "the size");

  // Resets are followed, too.
  await server.call("lights.patch", { light, patch: { intensity: null, enabled: null } });
  await server.call("environment.set", { name: null });
  await eventually(async () => {
    const sun = await lightThere();
    return sun.intensity === intensity && sun.enabled;
  }, "the light of the file in the second session");
  await eventually(
    async () => (await there("environment.list")).current !== "white",
    "the environment of the scene",
  );

  await server.call("scene.load", { name: "furnace" });
  const next = await eventually(async () => {
    const other = await otherSession();
    return other?.name !== name && other;
  }, "another session for another scene");
  assert.equal(next.scene, "furnace");
  await eventually(async () => (await kernelOf(next.name)) === "full", "the preset again");
  assert.equal(await select.inputValue(), "preset:svgf");
  await server.call("scene.load", { name: "shadow_objects" });
});

stage.test(
  "a comparison says what it prepares, and shows no figure before it means something",
  async () => {
    const { page } = await stage.watch();
    await openTab(page, "inspect");
    const facts = page.locator("[data-figure-of=similarity]");
    await facts.evaluate((node) => {
      window.told = [];
      new MutationObserver(() => window.told.push(node.textContent)).observe(node, {
        childList: true,
        characterData: true,
        subtree: true,
      });
    });
    await page.locator("select[name=compare]").selectOption("reference");
    await facts.getByText("SSIM").waitFor({ timeout: 90_000 });
    await dragView(page, { x: 150, y: 250 }, { x: 200, y: 260 });
    await facts.getByText("Preparing").waitFor();
    await facts.getByText("SSIM").waitFor({ timeout: 90_000 });
    const told = await page.evaluate(() => window.told);
    assert.match(told[0], /^Preparing/);
    for (const text of told.filter((one) => one.includes("SSIM"))) {
      const samples = Number(/with (\d+) samples/.exec(text)?.[1]);
      assert.ok(samples >= stage.samples, text);
    }
  },
);

stage.test("two frames are shown side by side, or their difference", async () => {
  const { page } = await stage.watch({ viewport: { width: 1200, height: 500 } });
  await settle(page, stage.server);
  const lightness = async (name) =>
    statistics(await thumbnail(page, await viewScreenshot(page, name))).mean;
  const plain = await lightness("compare_plain");
  await openTab(page, "inspect");
  await page.locator("select[name=compare]").selectOption("preset:svgf");
  const facts = page.locator("[data-figure-of=similarity]");
  await facts.getByText("SSIM").waitFor({ timeout: 60_000 });
  const layout = page.locator("select[name=compare_mode]");
  await layout.selectOption("difference");
  await page.locator(".second-label", { hasText: "Difference to" }).waitFor();
  const difference = await lightness("compare_difference");
  assert.ok(difference < 0.5 * plain, `a difference of ${difference}, the frame has ${plain}`);

  await layout.selectOption("side");
  await page.locator(".second-label", { hasText: /^Preset SVGF$/ }).waitFor();
  const [first, second, panel] = await Promise.all(
    ["#view", ".second", "#panel"].map((selector) => page.locator(selector).boundingBox()),
  );
  assert.ok(Math.abs(first.width - second.width) <= 1, `${first.width} and ${second.width}`);
  assert.ok(Math.abs(first.x + first.width - second.x) <= 1, "the halves are apart");
  assert.ok(second.x + second.width <= panel.x, "the panel covers the second frame");
  const { name } = await eventually(otherSession, "a second session");
  await eventually(async () => {
    const [here, there] = [
      await stage.server.call("session.info"),
      await stage.server.call("session.info", {}, name),
    ];
    return here.width < 500 && there.width === here.width;
  }, "both sessions to render half of the view");
  await facts.getByText("SSIM").waitFor({ timeout: 60_000 });
  await screenshot(page, "compare_side");
  assert.deepEqual(await seriousFindings(page), []);
  await page.locator("select[name=compare]").selectOption("");
  await eventually(
    async () => (await page.locator("#view").boundingBox()).width > 1000,
    "the whole view again",
  );
});

stage.test("a history buffer is overlaid", async () => {
  const { page } = await stage.watch();
  await openTab(page, "inspect");
  const select = page.locator("select[name=compare]");
  const options = await select
    .locator("option")
    .evaluateAll((nodes) => nodes.map(({ value }) => value));
  const history = options.find((value) => /^buffer:.*history/.test(value));
  assert.ok(history, options.join(", "));
  await select.selectOption(history);
  await page.locator("#compare").waitFor({ timeout: 60_000 });
  const opacity = () => page.locator(".second").evaluate((node) => Number(node.style.opacity));
  assert.equal(await opacity(), 0.6);
  const { name } = await eventually(otherSession, "a second session");
  await eventually(async () => {
    const { settings } = await stage.server.call("settings.get", {}, name);
    return settings.view.buffer === history.slice("buffer:".length);
  }, "the buffer in the second session");
  // A new canvas has the default size.
  const widthOf = () => page.locator(".second").evaluate(({ width }) => width);
  await eventually(async () => (await widthOf()) !== 300, "its first frame");
  await screenshot(page, "overlay");
});
