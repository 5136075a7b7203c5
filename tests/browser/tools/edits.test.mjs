// Lights that the page adds, colours and removes; edits saved as a document and opened again.

import assert from "node:assert/strict";
import { seriousFindings } from "../harness/axe.mjs";
import { eventually, openTab, screenshot } from "../harness/browser.mjs";
import { downloaded } from "../harness/downloads.mjs";
import { Stage } from "../harness/stage.mjs";

const stage = new Stage({
  view: { viewport: { width: 1000, height: 900 } },
  prepare: async (page) => {
    await openTab(page, "scene");
    await page.locator('[data-section="edits"] summary').click();
  },
});
const call = (...parameters) => stage.server.call(...parameters);
const lights = async () => (await call("lights.list")).lights;
const edits = async () => (await call("edits.get")).edits;
const added = async () => (await lights()).find((light) => light.added);

stage.test("keys add a light, give it a temperature and remove it; undo covers all", async () => {
  const { page } = await stage.sharedViewer();
  const section = page.locator("[data-section=lights]");
  await section.locator("select[name=light_type]").selectOption("rectangle");
  await section.getByRole("button", { name: "Add a light" }).focus();
  await page.keyboard.press("Enter");
  await eventually(added, "the light");
  const light = await added();
  await eventually(
    async () => (await section.locator("select[name=light]").inputValue()) === light.name,
    "it chosen",
  );
  const temperature = section.getByRole("textbox", { name: "Temperature" });
  await temperature.fill("2700");
  await temperature.press("Enter");
  await eventually(async () => (await added()).temperature === 2700, "its temperature");
  assert.ok((await added()).color[2] < 0.3, "a warm colour");
  const colour = section.locator("input[name=light_colour]");
  await eventually(async () => (await colour.inputValue()) !== "#ffffff", "the colour shown");
  await screenshot(page, "added_light");
  const undo = async () => {
    await page.locator("#view").focus();
    await page.keyboard.press("Control+z");
  };
  await undo();
  await eventually(async () => (await added()).temperature === undefined, "another colour");
  await section.getByRole("button", { name: "Remove this light" }).focus();
  await page.keyboard.press("Enter");
  await eventually(async () => !(await added()), "it removed");
  await undo();
  await eventually(added, "it there again");
  await undo();
  await eventually(async () => !(await added()), "it never added");
});

stage.test("edits are saved as a document, opened again, and undone as one", async () => {
  const { page } = await stage.sharedViewer();
  const before = await edits();
  const [first] = await lights();
  await call("lights.remove", { light: first.name });
  await call("lights.add", { type: "disk", name: "panel" });
  const document = await edits();
  const file = await downloaded(page, () =>
    page.getByRole("button", { name: "Save edits" }).click(),
  );
  assert.equal(file.name, "shadow_objects_edits.json");
  assert.deepEqual(JSON.parse(file.bytes), document);
  await call("edits.apply", { edits: before });
  await page.locator("input[name=edits_file]").setInputFiles(file.path);
  await eventually(async () => (await lights()).some(({ name }) => name === "panel"), "opened");
  await page.locator('[data-section="edits"] [role=status]', { hasText: "is applied" }).waitFor();
  assert.deepEqual(await edits(), document);
  await page.locator("#view").focus();
  await page.keyboard.press("Control+z");
  await eventually(async () => (await lights())[0].name === first.name, "undone");
  assert.deepEqual(await edits(), before);
});

stage.test("the edited scene is exported as a .glb file, which tells what it lacks", async () => {
  const { page } = await stage.sharedViewer();
  const [first] = await lights();
  await call("lights.patch", { light: first.name, patch: { intensity: 5 } });
  await call("section.set", { planes: [{ normal: [1, 0, 0], offset: 0.5 }] });
  const section = page.locator('[data-section="edits"]');
  const file = await downloaded(page, () =>
    section.getByRole("button", { name: "Export as .glb" }).click(),
  );
  assert.equal(file.name, "shadow_objects_edited.glb");
  assert.equal(file.bytes.toString("latin1", 0, 4), "glTF");
  const document = JSON.parse(file.bytes.subarray(20, 20 + file.bytes.readUInt32LE(12)));
  const intensities = document.extensions.KHR_lights_punctual.lights.map((one) => one.intensity);
  assert.ok(intensities.includes(5), "the changed light");
  await section.locator("li", { hasText: "section planes" }).waitFor();
  await section.getByRole("button", { name: "Export as .glb" }).waitFor();
  await screenshot(page, "exported_scene");
  await call("section.set", { planes: [] });
  await call("lights.patch", { light: first.name, patch: { intensity: null } });
});

for (const colorScheme of ["dark", "light"]) {
  stage.test(`lights and edits are accessible in the ${colorScheme} theme`, async () => {
    const { page } = await stage.watch({ colorScheme });
    await openTab(page, "scene");
    await page.locator('[data-section="edits"] summary').click();
    await page.locator('[data-section="edits"]').scrollIntoViewIfNeeded();
    assert.deepEqual(await seriousFindings(page), []);
    await screenshot(page, `edits_${colorScheme}`);
  });
}
