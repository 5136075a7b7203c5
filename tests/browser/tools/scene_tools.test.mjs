// Scene tools: lights, materials, picking, pixel values.

import assert from "node:assert/strict";
import { doubleClick, eventually, openTab, screenshot, settle } from "../harness/browser.mjs";
import { Stage } from "../harness/stage.mjs";

const stage = new Stage({
  resolution: "half",
  view: { viewport: { width: 1000, height: 900 } },
});

const sun = async () =>
  (await stage.server.call("lights.list")).lights.find(({ type }) => type === "directional");

stage.test("the sun is moved by its dial, resized and reset", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "scene");
  const before = await sun();
  const dial = page.getByRole("slider", { name: "Direction of the sun" });
  const { x, y, width } = await dial.boundingBox();
  await page.mouse.move(x + width / 2, y + width / 2);
  await page.mouse.down();
  await page.mouse.move(x + width * 0.9, y + width / 2, { steps: 5 });
  await page.mouse.up();
  await eventually(async () => {
    const { direction } = await sun();
    return direction[0] < -0.8 && direction[1] < 0;
  }, "a sun in the east");
  await dial.focus();
  await page.keyboard.press("Shift+ArrowUp");
  const raised = await eventually(async () => {
    const { direction } = await sun();
    return direction[1] < -0.3 && direction;
  }, "a higher sun");
  assert.ok(Math.abs(Math.hypot(...raised) - 1) < 1e-3);
  const diameter = page.getByRole("textbox", { name: "Angular diameter" }).first();
  await diameter.fill("4");
  await diameter.press("Enter");
  await eventually(async () => Math.abs((await sun()).angular_diameter - 4) < 1e-4, "a large sun");
  await screenshot(page, "sun");
  await page.getByRole("button", { name: "Reset this light" }).click();
  await eventually(
    async () => JSON.stringify((await sun()).direction) === JSON.stringify(before.direction),
    "the sun of the file",
  );
});

stage.test("a material is changed, and a roughness sweep restores its value", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "scene");
  await page.locator('[data-section="materials"] summary').first().click();
  const select = page.locator("select[name=material]");
  const { materials } = await stage.server.call("materials.list");
  const { name } = materials[1];
  await select.selectOption(name);
  const roughness = async () =>
    (await stage.server.call("materials.list")).materials.find((one) => one.name === name)
      .roughness;
  const section = page.locator('[data-section="materials"]');
  const entry = section.getByRole("textbox", { name: "Roughness" });
  await entry.fill("0.35");
  await entry.press("Enter");
  await eventually(async () => Math.abs((await roughness()) - 0.35) < 1e-5, "the roughness");
  const sent = () => page.evaluate(() => window.seen.sent["materials.patch"]);
  const before = await sent();
  // Runs in the page: the sweep does not wait for the test.
  await page.getByRole("button", { name: "Sweep the roughness" }).evaluate(async (button) => {
    const shown = button.parentElement.querySelector('[aria-label="Roughness"].number');
    for (;;) {
      if (button.textContent.startsWith("Sweep")) button.click();
      if (Number(shown.value) > 0.5) break;
      await new Promise(requestAnimationFrame);
    }
    button.click();
  });
  assert.ok((await sent()) > before + 1, "no patch was sent during the sweep");
  await eventually(
    async () => Math.abs((await roughness()) - 0.35) < 1e-5,
    "the previous roughness",
  );
});

stage.test("a click lists the value of every buffer at a pixel", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "inspect");
  await page.getByRole("switch", { name: "Inspect pixels" }).click();
  await page.mouse.click(300, 600);
  await page.locator(".pixel-values dd").first().waitFor({ timeout: 60_000 });
  const { buffers } = await stage.server.call("frame.inspect", { x: 0.3, y: 600 / 900 });
  const shown = await page
    .locator(".pixel-values dd[data-value]")
    .evaluateAll((nodes) => nodes.map((node) => node.dataset.value));
  assert.deepEqual(
    shown,
    buffers.map(({ name }) => name),
  );
  const { object, material } = await stage.server.call("scene.pick", { x: 0.3, y: 600 / 900 });
  const named = page.locator(".pixel-values dd[data-surface]");
  assert.deepEqual((await named.allTextContents()).slice(0, 2), [object, material]);
  assert.equal(await page.locator(".pixel-values dt").first().textContent(), "Object");
  assert.ok(await page.locator("#mark").isVisible());
  await screenshot(page, "inspector");
  await page.getByRole("switch", { name: "Inspect pixels" }).click();
  assert.equal(await page.locator("#mark").isVisible(), false);
});

stage.test("a double click focuses on the surface", async () => {
  const { page } = await stage.sharedViewer();
  const { position } = await stage.server.call("scene.pick", { x: 0.3, y: 600 / 900 });
  await doubleClick(page, { x: 300, y: 600 });
  await eventually(
    async () => {
      const { target } = await stage.server.call("camera.get");
      return Math.hypot(...target.map((value, axis) => value - position[axis])) < 0.05;
    },
    "the point as target",
    40_000,
  );
});

stage.test("shading modes are chosen by click and key, and undone", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "scene");
  const modes = page.getByRole("group", { name: "Shading" });
  const chosen = () => modes.locator('[aria-pressed="true"]').innerText();
  const mode = async () => (await stage.server.call("settings.get")).settings.view.shading;
  assert.equal(await chosen(), "Lit");
  for (const [label, value] of [
    ["Wireframe", "wireframe"],
    ["Clay", "clay"],
    ["Matcap", "matcap"],
    ["UV", "uv_checker"],
    ["Normals", "normals"],
  ]) {
    await modes.getByRole("button", { name: label }).click();
    await eventually(async () => (await mode()) === value, `the mode ${value}`);
    assert.equal(await chosen(), label);
    await settle(page, stage.server);
    await screenshot(page, `shading_${value}`);
  }
  // Changes of one setting that follow each other within 0.9 s are one step.
  await page.waitForTimeout(1000);
  await modes.getByRole("button", { name: "Clay" }).focus();
  await page.keyboard.press("Enter");
  await eventually(async () => (await mode()) === "clay", "clay, by key");
  await page.getByRole("button", { name: /^Undo/ }).click();
  await eventually(async () => (await mode()) === "normals", "what was before");
  await modes.getByRole("button", { name: "Lit" }).click();
  await eventually(async () => (await mode()) === "lit", "the lit scene");
});
