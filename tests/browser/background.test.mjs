// What is seen behind the scene: a color, a gradient, the blurred environment; the studio.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { eventually, screenshot, settle, unfoldAll } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({ scene: "mirror", view: { viewport: { width: 720, height: 405 } } });

/** Colours of the session's image on a grid of 16 x 9, rows from the top. */
async function pixels(page) {
  const capture = await stage.server.call("frame.capture", { samples: 4 });
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const context = new OffscreenCanvas(16, 9).getContext("2d");
    context.drawImage(bitmap, 0, 0, 16, 9);
    const { data } = context.getImageData(0, 0, 16, 9);
    return Array.from({ length: 144 }, (_, index) => [...data.slice(4 * index, 4 * index + 3)]);
  }, capture.data);
}

async function choose(page, kind) {
  await page.locator('[data-setting="background.show"]').selectOption(kind);
  await eventually(
    async () => (await stage.server.setting("background.show")) === kind,
    `the background ${kind}`,
  );
  await settle(page, stage.server);
}

stage.test("the background is a color, a gradient or the blurred environment", async () => {
  const { page } = await stage.sharedViewer();
  // The sky alone.
  await stage.server.call("camera.set", { eye: [0, 50, 0], target: [10, 51, 0], up: [0, 1, 0] });
  await stage.server.call("settings.patch", { patch: { tone_map: { curve: "linear" } } });
  await unfoldAll(page);
  await choose(page, "color");
  await page.locator('[data-setting="background.color"]').fill("#336699");
  await eventually(
    async () => (await stage.server.setting("background.color")) === "#336699",
    "the color",
  );
  await settle(page, stage.server);
  await screenshot(page, "background_color");
  const differs = (await pixels(page)).filter(([r, g, b]) =>
    [r - 0x33, g - 0x66, b - 0x99].some((difference) => Math.abs(difference) > 2),
  );
  assert.deepEqual(differs, [], "the background has another color");

  await choose(page, "gradient");
  await screenshot(page, "background_gradient");
  const gradient = await pixels(page);
  const luminance = ([r, g, b]) => 0.2 * r + 0.7 * g + 0.1 * b;
  assert.ok(Math.abs(luminance(gradient[0]) - luminance(gradient[15])) < 4, "rows are even");
  assert.ok(Math.abs(luminance(gradient[0]) - luminance(gradient[128])) > 10, "columns are not");

  await page.waitForTimeout(1000); // sooner it is one step with the change before
  await choose(page, "blurred");
  await screenshot(page, "background_blurred");
  assert.deepEqual(await seriousFindings(page), []);
  await page.getByRole("button", { name: /^Undo/ }).click();
  await eventually(
    async () => (await stage.server.setting("background.show")) === "gradient",
    "undo",
  );
  await stage.server.call("settings.patch", { patch: { background: null, tone_map: null } });
});

stage.test("the studio can be chosen in every scene", async () => {
  const { page } = await stage.sharedViewer();
  await page.getByLabel("Environment", { exact: true }).selectOption("studio");
  await eventually(
    async () => (await stage.server.call("environment.list")).current === "studio",
    "the studio",
  );
  await settle(page, stage.server);
  await screenshot(page, "environment_studio");
});
