// The lens, the path through the bookmarks, and the exploded view.

import assert from "node:assert/strict";
import { seriousFindings } from "../harness/axe.mjs";
import { eventually, openTab, screenshot } from "../harness/browser.mjs";
import { Stage } from "../harness/stage.mjs";

const stage = new Stage({
  view: { viewport: { width: 1000, height: 900 } },
  prepare: (page) => openTab(page, "scene"),
});
const call = (...parameters) => stage.server.call(...parameters);
const camera = () => call("camera.get");
const settings = async () => (await call("settings.get")).settings;

stage.test("a focal length changes the field of view, and undo brings it back", async () => {
  const { page } = await stage.sharedViewer();
  const before = (await camera()).vertical_fov;
  const length = page.getByRole("textbox", { name: "Focal length" });
  await length.fill("12");
  await length.press("Enter");
  await eventually(async () => Math.abs((await camera()).vertical_fov - 90) < 0.1, "90 degrees");
  await page.locator("#view").focus();
  await page.keyboard.press("Control+z");
  await eventually(async () => (await camera()).vertical_fov === before, "as before");
});

stage.test("a click chooses what is in focus", async () => {
  const { page } = await stage.sharedViewer();
  await page.getByRole("button", { name: "Focus", exact: true }).click();
  const view = await page.locator("#view").boundingBox();
  await page.mouse.click(view.x + view.width * 0.3, view.y + view.height * 0.5);
  await eventually(async () => (await settings()).lens.depth_of_field, "depth of field");
  const { eye, target } = await camera();
  const distance = Math.hypot(...eye.map((value, i) => value - target[i]));
  const { focus_distance: focus } = (await settings()).lens;
  assert.ok(focus > 0.2 * distance && focus < 20 * distance, `${focus} m of ${distance} m`);
  await page.waitForFunction(
    () => document.querySelector('[data-path="lens.depth_of_field"] input').checked,
  );
  await screenshot(page, "depth_of_field");
  await call("settings.patch", { patch: { lens: null } });
});

stage.test("the camera plays the path through the bookmarks", async () => {
  const { page } = await stage.sharedViewer();
  const play = page.getByRole("button", { name: "Play path" });
  assert.equal(await play.isVisible(), false, "without bookmarks there is none");
  const { target } = await camera();
  const eyes = [
    [3, 2, 3],
    [-3, 2, 3],
  ];
  for (const eye of eyes) await call("bookmarks.add", { eye, target });
  await play.waitFor();
  await page.getByRole("slider", { name: "Duration" }).focus();
  await page.keyboard.press("Home");
  await screenshot(page, "camera_path");
  await play.click();
  const isAt = async (place) => {
    const { eye } = await camera();
    return Math.hypot(...eye.map((value, i) => value - place[i])) < 0.01;
  };
  await eventually(() => isAt(eyes[1]), "the last bookmark");
  await play.waitFor();
  const { violations } = { violations: await seriousFindings(page) };
  assert.deepEqual(violations, []);
  for (const { name } of (await call("bookmarks.list")).bookmarks) {
    await call("bookmarks.remove", { name });
  }
  await play.waitFor({ state: "hidden" });
});

stage.test("a slider moves the parts of the model apart", async () => {
  const { page } = await stage.sharedViewer();
  await page.locator('[data-section="objects"] summary').click();
  await page.getByRole("slider", { name: "Exploded view" }).focus();
  for (let i = 0; i < 10; i += 1) await page.keyboard.press("ArrowRight");
  await eventually(async () => (await settings()).view.explode > 0, "parts apart");
  await screenshot(page, "exploded_view");
  await page.locator("#view").focus();
  await page.keyboard.press("Control+z");
  await eventually(async () => (await settings()).view.explode === 0, "assembled");
});
