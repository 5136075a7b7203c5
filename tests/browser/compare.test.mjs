// Two pictures of one scene beside each other, and several people in one session.

import assert from "node:assert/strict";
import test, { after, before } from "node:test";
import {
  distance,
  dragPicture,
  eventually,
  firstPicture,
  launchBrowser,
  openTab,
  openViewer,
  screenshot,
} from "./harness/browser.mjs";
import { startServer } from "./harness/server.mjs";

const small = { viewport: { width: 800, height: 450 } };

let server;
let browser;

before(async () => {
  server = await startServer();
  await server.call("scene.load", { name: "shadow_objects" });
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/** Skips a test where the server has no sessions to make. */
async function lacksSessions(t) {
  const { methods } = await server.call("rpc.discover");
  const lacks = !methods.some(({ name }) => name === "session.create");
  if (lacks) t.skip("the server makes no sessions");
  return lacks;
}

async function otherSession() {
  const { sessions } = await server.call("session.list");
  return sessions.find(({ name }) => name !== "main");
}

test("a preset is compared in a session of its own that follows the camera", async (t) => {
  if (await lacksSessions(t)) return;
  const { page, context, complaints } = await openViewer(browser, server.url, small);
  await firstPicture(page);
  await openTab(page, "inspect");
  await page.locator("select[name=compare]").selectOption("preset:svgf");
  const divider = page.getByRole("slider", { name: "Line between the two pictures" });
  await divider.waitFor({ timeout: 60_000 });
  const { name } = await eventually(otherSession, "a second session");
  await eventually(async () => {
    const { settings } = await server.call("settings.get", {}, name);
    return settings.shadow_blur.kernel === "full";
  }, "the preset over there");
  assert.equal(await server.setting("shadow_blur.kernel"), "separable");

  await dragPicture(page, { x: 150, y: 250 }, { x: 260, y: 270 });
  await eventually(async () => {
    const here = await server.call("camera.get");
    const there = await server.call("camera.get", {}, name);
    return distance(here.eye, there.eye) < 1e-4 && here.name === null;
  }, "both cameras in the same place");
  const alike = await eventually(async () => {
    const text = await page.locator("[data-figure-of=similarity]").textContent();
    const figure = Number(/SSIM ([\d.]+)/.exec(text)?.[1]);
    // The first figures are of pictures on either side of the move.
    return figure > 0.5 && figure;
  }, "both pictures to be alike", 60_000);
  assert.ok(alike <= 1, String(alike));

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
  assert.deepEqual(complaints, []);
  await context.close();
});

test("a buffer of history lies over the picture", async (t) => {
  if (await lacksSessions(t)) return;
  const { page, context } = await openViewer(browser, server.url, small);
  await firstPicture(page);
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
    const { settings } = await server.call("settings.get", {}, name);
    return settings.view.buffer === history.slice("buffer:".length);
  }, "the buffer over there");
  await page.waitForTimeout(1500);
  await screenshot(page, "overlay");
  await context.close();
});

test("viewers see who is here, take control and hand it over", async (t) => {
  if (await lacksSessions(t)) return;
  const first = await openViewer(browser, server.url, small);
  await firstPicture(first.page);
  const second = await openViewer(browser, server.url, small);
  await firstPicture(second.page);
  const open = ({ page }) => page.getByRole("button", { name: "Who is here" }).click();
  await eventually(
    async () => (await first.page.locator(".people-count").textContent()) === "2",
    "two viewers",
  );
  await open(first);
  await first.page.getByRole("textbox", { name: "Your name" }).fill("Ada");
  await first.page.getByRole("textbox", { name: "Your name" }).press("Enter");
  await open(second);
  await second.page.locator(".person", { hasText: "Ada" }).waitFor({ timeout: 20_000 });
  await first.page.getByRole("button", { name: "Only I change things" }).click();
  await second.page.locator(".in-control").waitFor({ timeout: 20_000 });
  await screenshot(second.page, "people");

  const before = await server.call("camera.get");
  await dragPicture(second.page, { x: 100, y: 300 }, { x: 260, y: 320 });
  await second.page.waitForTimeout(500);
  assert.deepEqual((await server.call("camera.get")).eye, before.eye, "moved without control");

  if (await first.page.locator("#people-card").isHidden()) await open(first);
  await first.page.getByRole("button", { name: "Hand over to" }).click();
  await eventually(
    async () => (await second.page.locator(".without-control").count()) === 0,
    "control for the second viewer",
  );
  await dragPicture(second.page, { x: 100, y: 300 }, { x: 260, y: 320 });
  await eventually(
    async () => distance((await server.call("camera.get")).eye, before.eye) > 0.01,
    "a camera moved by the second viewer",
  );
  await first.context.close();
  await second.context.close();
});
