// One history of everything that the page changes, with named steps.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import {
  distance,
  eventually,
  firstFrame,
  screenshot,
  settle,
  staticCamera,
  unfoldAll,
} from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({ view: { viewport: { width: 1000, height: 800 } } });

const call = (method, params) => stage.server.call(method, params);
const undoButton = (page, step) =>
  page.getByRole("button", { name: step ? `Undo: ${step} (Ctrl Z)` : "Undo (Ctrl Z)" });
const redoButton = (page, step) =>
  page.getByRole("button", { name: step ? `Redo: ${step} (Ctrl Shift Z)` : "Redo" });

async function type(field, value) {
  await field.fill(String(value));
  await field.press("Enter");
}

/** Undoes and redoes the last step, and waits for its value before and after. */
async function undoAndRedo(page, step, read, before, after) {
  const is = (expected) => eventually(async () => String(await read()) === String(expected), step);
  await is(after);
  await undoButton(page, step).click();
  await is(before);
  await page.locator(".toast", { hasText: `Undone: ${step}` }).waitFor();
  await redoButton(page, step).click();
  await is(after);
  await undoButton(page, step).click();
  await is(before);
}

async function sun() {
  return (await call("lights.list")).lights.find(({ type: kind }) => kind === "directional");
}

stage.test("settings, lights, materials and the environment are undone by name", async () => {
  const { page } = await stage.watch();
  await unfoldAll(page);
  assert.equal(await undoButton(page).getAttribute("aria-disabled"), "true");

  await type(page.locator('[data-path="exposure.compensation"] input.number'), 1.5);
  const exposure = () => stage.server.setting("exposure.compensation");
  await undoAndRedo(page, "exposure (EV)", exposure, 0, 1.5);

  const { name, intensity } = await sun();
  const lights = page.locator("[data-section=lights]");
  await type(lights.getByRole("textbox", { name: "Intensity" }), 9);
  const light = async () => (await sun()).intensity;
  await undoAndRedo(page, `intensity of ${name}`, light, intensity, 9);
  assert.deepEqual((await sun()).changed, [], "an undone change is no change");

  const [material] = (await call("materials.list")).materials;
  await page.locator("select[name=material]").selectOption(material.name);
  const materials = page.locator("[data-section=materials]");
  await type(materials.getByRole("textbox", { name: "Metallic" }), 0.25);
  const metallic = async () =>
    (await call("materials.list")).materials.find((one) => one.name === material.name).metallic;
  await undoAndRedo(page, `metallic of ${material.name}`, metallic, material.metallic, 0.25);

  await type(materials.getByRole("textbox", { name: "Clear coat" }), 0.5);
  const clearcoat = async () =>
    (await call("materials.list")).materials.find((one) => one.name === material.name).clearcoat;
  await undoAndRedo(page, `clearcoat of ${material.name}`, clearcoat, material.clearcoat, 0.5);

  await page.locator("select[name=environment]").selectOption("white");
  const environment = async () => (await call("environment.list")).current;
  await undoAndRedo(page, "environment", environment, null, "white");
  await screenshot(page, "undo");
  assert.deepEqual(await seriousFindings(page), []);
});

stage.test("a movement of the camera is one step, and undo returns in a transition", async () => {
  const { page } = await stage.watch();
  const before = await staticCamera(page, stage.server);
  await page.locator("#view").focus();
  await page.keyboard.press("ArrowLeft", { delay: 400 });
  const after = await staticCamera(page, stage.server);
  assert.ok(distance(before.eye, after.eye) > 0.05);
  await page.keyboard.press("Control+z");
  const back = await staticCamera(page, stage.server);
  assert.ok(distance(back.eye, before.eye) < 1e-3, `${back.eye} instead of ${before.eye}`);
  await page.keyboard.press("Control+Shift+Z");
  const again = await staticCamera(page, stage.server);
  assert.ok(distance(again.eye, after.eye) < 1e-3, `${again.eye} instead of ${after.eye}`);
  assert.equal(await redoButton(page).getAttribute("aria-disabled"), "true");
});

stage.test(
  "undo of a scene restores the scene before with all that was changed in it",
  async () => {
    const { page } = await stage.watch();
    const { name } = await sun();
    await type(
      page.locator("[data-section=lights]").getByRole("textbox", { name: "Intensity" }),
      7,
    );
    await eventually(async () => (await sun()).intensity === 7, "the light");
    await page.locator("#view").focus();
    await page.keyboard.press("ArrowUp", { delay: 200 });
    const { eye } = await staticCamera(page, stage.server);
    await page.locator("select[name=scene]").selectOption("mirror");
    await page.waitForFunction(() => document.title.startsWith("mirror"));
    await undoButton(page, "scene mirror").click();
    await page.waitForFunction(() => document.title.startsWith("shadow_objects"));
    await firstFrame(page);
    await settle(page, stage.server);
    assert.ok(distance((await call("camera.get")).eye, eye) < 1e-3);
    assert.equal((await sun()).intensity, 7);
    // The steps before are still there.
    await undoButton(page, "camera").click();
    await staticCamera(page, stage.server);
    await undoButton(page, `intensity of ${name}`).click();
    await eventually(async () => (await sun()).intensity !== 7, "the light of the file");
    await redoButton(page, `intensity of ${name}`).click();
    await redoButton(page, "camera").click();
    await redoButton(page, "scene mirror").click();
    await page.waitForFunction(() => document.title.startsWith("mirror"));
  },
);

stage.test("when another viewer loads a scene, steps in the one before are void", async () => {
  const { page } = await stage.watch();
  await type(page.locator('[data-path="exposure.compensation"] input.number'), 1);
  await page.locator("#view").focus();
  await page.keyboard.press("ArrowUp", { delay: 100 });
  await undoButton(page, "camera").waitFor();
  const { current } = await call("scene.list");
  await call("scene.load", { name: current === "mirror" ? "shadow_objects" : "mirror" });
  await undoButton(page, "exposure (EV)").waitFor();
});
