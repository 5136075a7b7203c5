// What the page tells without being asked: refinement, gestures, tooltips, the list of buffers.

import assert from "node:assert/strict";
import { eventually, openTab, screenshot } from "./harness/browser.mjs";
import { inFirefox } from "./harness/environment.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({ scene: "mirror", view: { viewport: { width: 720, height: 405 } } });

stage.test("a static view says how far it is refined, and nothing once it has converged", async () => {
  const { page } = await stage.sharedViewer();
  const indicator = page.locator("#refining");
  await stage.server.call("settings.patch", {
    patch: { accumulation: { max_samples: 4096, by_noise: false } },
  });
  await stage.server.call("camera.orbit", { yaw: 10, pitch: 0 });
  await indicator.getByText(/^\d+ of 4096 samples$/).waitFor();
  await screenshot(page, "refining");
  const counted = async () => Number.parseInt(await indicator.textContent(), 10);
  const before = await counted();
  await eventually(async () => (await counted()) > before, "more samples");
  await stage.server.call("settings.patch", {
    patch: { accumulation: { max_samples: 2 }, reference: { samples: 4096 } },
  });
  await indicator.getByText(/^\d+ of 4096 path traced samples$/).waitFor();
  await screenshot(page, "refining_path_traced");
  await stage.server.call("settings.patch", { patch: { reference: { samples: 1 } } });
  await indicator.waitFor({ state: "hidden" });
});

/** The help of a page that is opened with these options begins with this. */
async function helpBeginsWith(first, options) {
  const { page } = await stage.watch(options);
  await page.keyboard.press("?");
  const titles = page.locator("#help h2");
  await titles.first().waitFor();
  assert.equal(await titles.first().textContent(), first);
  await screenshot(page, `help_${first.toLowerCase()}`);
}

stage.test("on a touch screen the help begins with gestures", async (t) => {
  if (inFirefox) return t.skip("Firefox cannot be told that its screen is touched");
  const phone = { hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } };
  await helpBeginsWith("Touch", phone);
});

stage.test("with a mouse the help begins with it", () => helpBeginsWith("Mouse"));

stage.test("a tooltip goes with what it explains, and with Escape", async () => {
  const { page } = await stage.sharedViewer();
  const tip = page.getByRole("tooltip");
  const help = page.getByRole("button", { name: "Help (?)" });
  await help.hover();
  await tip.getByText("Help (?)").waitFor();
  await page.evaluate(() => (document.querySelector("#panel").hidden = true));
  await tip.waitFor({ state: "hidden" });
  await page.evaluate(() => (document.querySelector("#panel").hidden = false));
  await page.mouse.move(10, 10);
  await help.hover();
  await tip.getByText("Help (?)").waitFor();
  await page.keyboard.press("Escape");
  await tip.waitFor({ state: "hidden" });
});

stage.test("the list of buffers follows the settings", async () => {
  const { page } = await stage.sharedViewer();
  await openTab(page, "inspect");
  const names = () =>
    page
      .locator("select[name=buffer] option")
      .evaluateAll((options) => options.map(({ value }) => value));
  const reflections = async () => (await names()).some((name) => name.startsWith("specular."));
  assert.ok(await reflections());
  // By another client, and by this page.
  await stage.server.call("settings.patch", { patch: { specular: { enabled: false } } });
  await eventually(async () => !(await reflections()), "a list without reflections");
  await stage.server.call("settings.patch", { patch: { specular: { enabled: true } } });
  await eventually(reflections, "a list with reflections");
});

stage.test("the gallery of buffers has one sample of each at once, and refines them", async () => {
  const { page } = await stage.sharedViewer();
  const most = (samples) =>
    stage.server.call("settings.patch", {
      patch: { accumulation: { max_samples: samples, by_noise: false }, reference: { samples } },
    });
  await most(65_536);
  await openTab(page, "inspect");
  await page.getByRole("button", { name: "Show thumbnails of all buffers" }).click();
  const tiles = await page.locator("#buffer-gallery .tile").count();
  const images = (samples) => page.locator(`#buffer-gallery img[data-samples="${samples}"]`);
  await eventually(async () => (await images("1").count()) === tiles, "an image of each", 120_000);
  await screenshot(page, "buffer_gallery");
  assert.equal(await page.evaluate(() => window.seen.frame.final), false, "it has converged");
  await most(2);
  await eventually(async () => (await images("all").count()) === tiles, "better ones", 120_000);
});

stage.test("the first visit tells how to move, until the view is moved", async () => {
  const context = await stage.context({ firstVisit: true });
  const { page } = await stage.watch({ context });
  const hint = page.getByText(/^Drag to orbit, wheel to zoom/);
  await hint.waitFor();
  await screenshot(page, "first_hint");
  await page.locator("#view").focus();
  await page.keyboard.press("ArrowLeft", { delay: 50 });
  await hint.waitFor({ state: "hidden" });
  const { page: again } = await stage.watch({ context });
  assert.equal(await again.getByText(/^Drag to orbit/).count(), 0);
});

stage.test("quality is the first control: draft, balanced or best", async () => {
  await stage.server.call("settings.patch", { patch: { accumulation: null } });
  const { page } = await stage.watch();
  const quality = page.getByRole("group", { name: "Quality" });
  const pressed = () =>
    quality.locator("[aria-pressed=true]").evaluateAll((all) => all.map((one) => one.textContent));
  assert.deepEqual(await pressed(), ["Balanced"]);
  const first = page.locator("#page-scene .field").first();
  assert.ok(await first.getByText("Quality").isVisible(), "it is not the first");
  await quality.getByRole("button", { name: "Draft" }).click();
  await eventually(
    async () => (await stage.server.setting("accumulation.max_samples")) === 8,
    "few samples",
  );
  assert.equal(await stage.server.setting("indirect.enabled"), false);
  assert.deepEqual(await pressed(), ["Draft"]);
  await screenshot(page, "quality");
  await quality.getByRole("button", { name: "Balanced" }).click();
  await eventually(async () => await stage.server.setting("indirect.enabled"), "indirect light");
  assert.deepEqual(await pressed(), ["Balanced"]);
});
