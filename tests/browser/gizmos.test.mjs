// Handles over the view: they move and turn section planes and lights, by drags and by keys.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { distance, eventually, openTab, screenshot, setCamera } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const unfoldPlanes = async (page) => {
  await openTab(page, "scene");
  await page.locator('[data-section="section_planes"] summary').click();
};
const stage = new Stage({
  view: { viewport: { width: 1200, height: 900 } },
  prepare: unfoldPlanes,
});
const call = (...parameters) => stage.server.call(...parameters);
const planes = async () => (await call("section.get")).planes;
const handle = (page, id) => page.locator(`#gizmos [data-handle=${id}]`);

/** Drags a handle by pixels in steps; `held` happens before the button is released. */
async function dragHandle(page, id, right, down, held = async () => {}) {
  const { x, y, width, height } = await handle(page, id).boundingBox();
  const from = { x: x + width / 2, y: y + height / 2 };
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= 6; step += 1) {
    await page.mouse.move(from.x + (right * step) / 6, from.y + (down * step) / 6);
  }
  await held();
  await page.mouse.up();
}

async function undo(page) {
  await page.locator("#view").focus();
  await page.keyboard.press("Control+z");
}

/** The shared page with one plane, across Y in the middle of the scene. */
async function withPlane() {
  const { page } = await stage.sharedViewer();
  await setCamera(page, stage.server, { eye: [0, 1, 8], target: [0, 1, 0] });
  await call("section.set", { planes: [{ normal: [0, 1, 0], offset: 0.7 }] });
  await handle(page, "normal").waitFor();
  return page;
}

/** The shared page with a chosen light that the session has added. */
async function withLight(type, name, patch) {
  const { page } = await stage.sharedViewer();
  await setCamera(page, stage.server, { eye: [0, 1, 8], target: [0, 1, 0] });
  await call("lights.add", { type, name, patch });
  const select = page.locator("select[name=light]");
  await select.locator("option", { hasText: name }).waitFor({ state: "attached" });
  await select.selectOption(name);
  await handle(page, type === "directional" ? "turn" : "x").waitFor();
  const light = async () =>
    (await call("lights.list")).lights.find((one) => one.name === name);
  return { page, light };
}

stage.test("a drag of a plane's arrow moves the plane; one undo brings it back", async () => {
  const page = await withPlane();
  const { eye } = await call("camera.get");
  await screenshot(page, "plane_handles");
  await dragHandle(page, "normal", 0, -60);
  const moved = await eventually(async () => {
    const [{ offset }] = await planes();
    return offset > 0.75 && offset;
  }, "a higher plane");
  const number = page.getByRole("textbox", { name: "Position 1" });
  const follows = async () => Math.abs(Number(await number.inputValue()) - moved) < 0.05;
  await eventually(follows, "the panel's number");
  assert.deepEqual((await call("camera.get")).eye, eye, "the drag moved the camera");
  await undo(page);
  await eventually(async () => Math.abs((await planes())[0].offset - 0.7) < 1e-5, "the old place");
  await page.locator(".toast", { hasText: "Undone: move section plane 1" }).waitFor();
  await call("section.set", { planes: [] });
  await handle(page, "normal").waitFor({ state: "detached" });
});

stage.test("Escape brings a dragged plane back, without a step of the history", async () => {
  const page = await withPlane();
  const undoLabel = () =>
    page.locator("#panel header").getByRole("button", { name: /^Undo/ }).getAttribute("aria-label");
  const before = await undoLabel();
  await dragHandle(page, "normal", 0, -60, async () => {
    await eventually(async () => (await planes())[0].offset > 0.75, "a higher plane");
    await page.keyboard.press("Escape");
    await eventually(async () => Math.abs((await planes())[0].offset - 0.7) < 1e-5, "its place");
    await page.mouse.move(600, 600);
  });
  assert.ok(Math.abs((await planes())[0].offset - 0.7) < 1e-5, "the drag went on");
  assert.equal(await undoLabel(), before);
  await call("section.set", { planes: [] });
});

stage.test("a plane is turned by a drag and by keys, and stays where its handles are", async () => {
  const page = await withPlane();
  await dragHandle(page, "turn", 70, 0);
  const turned = await eventually(async () => {
    const [{ normal }] = await planes();
    return Math.abs(normal[1]) < 0.98 && normal;
  }, "another normal");
  assert.ok(Math.abs(Math.hypot(...turned) - 1) < 1e-5);
  await handle(page, "turn").focus();
  await page.keyboard.press("Shift+ArrowUp");
  await eventually(async () => distance((await planes())[0].normal, turned) > 0.1, "a step");
  await undo(page);
  await eventually(async () => distance((await planes())[0].normal, turned) < 1e-5, "no step");
  await undo(page);
  await eventually(async () => (await planes())[0].normal[1] > 0.9999, "the first normal");
  await page.getByRole("button", { name: "Handles of plane 1" }).click();
  await handle(page, "normal").waitFor({ state: "detached" });
  await page.getByRole("button", { name: "Handles of plane 1" }).click();
  await handle(page, "normal").waitFor();
  await page.locator('[data-section="section_planes"] summary').click();
  await handle(page, "normal").waitFor({ state: "detached" });
  await page.locator('[data-section="section_planes"] summary').click();
  await call("section.set", { planes: [] });
});

stage.test("a light moves along an axis, across the view and by keys", async () => {
  const start = [0, 1.2, 1];
  const { page, light } = await withLight("point", "bulb", { position: start });
  await screenshot(page, "light_handles");
  await dragHandle(page, "x", 80, 15);
  const along = await eventually(async () => {
    const { position } = await light();
    return position[0] > 0.2 && position;
  }, "a light at the right");
  assert.ok(distance(along.slice(1), start.slice(1)) < 1e-5, `${along}`);
  await undo(page);
  await eventually(async () => distance((await light()).position, start) < 1e-5, "its place");
  await page.locator(".toast", { hasText: "Undone: move light bulb" }).waitFor();
  await dragHandle(page, "centre", -40, -40);
  const across = await eventually(async () => {
    const { position } = await light();
    return position[0] < -0.1 && position[1] > 1.3 && position;
  }, "a light further up at the left");
  assert.ok(Math.abs(across[2] - start[2]) < 1e-4, `${across}`);
  const slider = page.getByRole("slider", { name: "Move bulb along Y" });
  await slider.focus();
  await page.keyboard.press("ArrowDown");
  await eventually(async () => (await light()).position[1] < across[1] - 1e-4, "a step down");
  const { position } = await light();
  const text = `${position[1].toFixed(2)} metres`;
  await eventually(async () => (await slider.getAttribute("aria-valuetext")) === text, text);
  await call("lights.remove", { light: "bulb" });
  await handle(page, "x").waitFor({ state: "detached" });
});

stage.test("with Shift a drag is finer", async () => {
  const start = [0, 1.2, 1];
  const { page, light } = await withLight("point", "bulb", { position: start });
  const dragged = async () => {
    await dragHandle(page, "x", 90, 0);
    return eventually(async () => {
      const shift = (await light()).position[0];
      return shift > 1e-4 && shift;
    }, "a movement");
  };
  await page.keyboard.down("Shift");
  const fine = await dragged();
  await page.keyboard.up("Shift");
  await undo(page);
  await eventually(async () => (await light()).position[0] < 1e-5, "its place");
  await dragHandle(page, "x", 90, 0);
  await eventually(async () => (await light()).position[0] > 5 * fine, "a coarse movement");
  await call("lights.remove", { light: "bulb" });
});

stage.test("a directional light is turned at the scene's centre", async () => {
  const { page, light } = await withLight("directional", "low sun", { direction: [1, -1, 0] });
  assert.equal(await page.locator("#gizmos .gizmo").count(), 1);
  const { direction } = await light();
  await dragHandle(page, "turn", -50, 0);
  await eventually(async () => distance((await light()).direction, direction) > 0.1, "a turn");
  await undo(page);
  await eventually(async () => distance((await light()).direction, direction) < 1e-5, "no turn");
  await call("lights.remove", { light: "low sun" });
});

stage.test("handles are hidden behind the camera, without control and with the panel", async () => {
  const page = await withPlane();
  await setCamera(page, stage.server, { eye: [0, 1, 8], target: [0, 1, 20] });
  await handle(page, "normal").waitFor({ state: "hidden" });
  await setCamera(page, stage.server, { eye: [0, 1, 8], target: [0, 1, 0] });
  await handle(page, "normal").waitFor();
  await page.keyboard.press("h");
  await handle(page, "normal").waitFor({ state: "detached" });
  await page.keyboard.press("h");
  await handle(page, "normal").waitFor();
  const other = await stage.watch();
  await other.page.getByRole("button", { name: "Participants" }).click();
  await other.page.getByRole("button", { name: "Take exclusive control" }).click();
  await handle(page, "normal").waitFor({ state: "detached" });
  await call("session.control", { mode: "shared" });
  await handle(page, "normal").waitFor();
  await call("section.set", { planes: [] });
});

for (const colorScheme of ["dark", "light"]) {
  stage.test(`handles are accessible and large enough in the ${colorScheme} theme`, async () => {
    const { page } = await stage.watch({ colorScheme });
    await unfoldPlanes(page);
    await page.getByRole("button", { name: "Cut along X" }).click();
    await handle(page, "normal").waitFor();
    const { width, height } = await handle(page, "normal").boundingBox();
    assert.ok(width >= 24 && height >= 24, `${width} x ${height}`);
    await handle(page, "turn").focus();
    await screenshot(page, `handles_${colorScheme}`);
    assert.deepEqual(await seriousFindings(page), []);
    await call("section.set", { planes: [] });
  });
}
