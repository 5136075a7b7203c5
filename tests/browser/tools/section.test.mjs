// Planes that cut the scene open: added, moved, flipped, switched off and removed by keys; shared
// with other viewers; undone.

import assert from "node:assert/strict";
import { seriousFindings } from "../harness/axe.mjs";
import { eventually, openTab, screenshot } from "../harness/browser.mjs";
import { Stage } from "../harness/stage.mjs";

const stage = new Stage({
  view: { viewport: { width: 1000, height: 900 } },
  prepare: async (page) => {
    await openTab(page, "scene");
    await page.locator('[data-section="section_planes"] summary').click();
  },
});
const call = (...parameters) => stage.server.call(...parameters);
const planes = async () => (await call("section.get")).planes;
const soon = (condition, what) => eventually(async () => condition(await planes()), what);

stage.test("keys add, move, flip and remove a plane; undo brings it back", async () => {
  const { page } = await stage.sharedViewer();
  const press = async (name) => {
    await page.getByRole("button", { name, exact: true }).focus();
    await page.keyboard.press("Enter");
  };
  await press("Cut along X");
  await soon((all) => all.length === 1 && all[0].normal[0] === 1, "a plane along X");
  const [{ offset }] = await planes();
  await page.getByRole("slider", { name: "Position 1" }).focus();
  for (let i = 0; i < 5; i += 1) await page.keyboard.press("ArrowRight");
  await soon(([plane]) => plane.offset > offset, "the plane moved");
  await screenshot(page, "section_plane");
  const moved = (await planes())[0].offset;
  await press("Flip plane 1");
  await soon(([plane]) => plane.normal[0] === -1, "the other half");
  assert.ok(Math.abs((await planes())[0].offset + moved) < 1e-4);
  await page.getByRole("switch", { name: /^Plane 1/ }).focus();
  await page.keyboard.press("Space");
  await soon(([plane]) => !plane.enabled, "the plane switched off");
  await press("Remove plane 1");
  await soon((all) => all.length === 0, "no plane");
  await page.locator("#view").focus();
  await page.keyboard.press("Control+z");
  await soon((all) => all.length === 1 && !all[0].enabled, "the plane again");
});

stage.test("planes of another viewer are shown, up to six", async () => {
  const { page } = await stage.sharedViewer();
  const plane = { normal: [0, 1, 0], offset: 1 };
  await call("section.set", { planes: Array(5).fill(plane) });
  const switches = page.getByRole("switch", { name: /^Plane \d: Y/ });
  await eventually(async () => (await switches.count()) === 5, "five planes");
  await page.getByRole("button", { name: "Cut across the View" }).click();
  await soon((all) => all.length === 6, "six planes");
  await eventually(
    () => page.getByRole("button", { name: "Cut along X" }).isDisabled(),
    "no seventh",
  );
  await call("section.set", { planes: [] });
  await eventually(async () => (await switches.count()) === 0, "no plane");
});

for (const colorScheme of ["dark", "light"]) {
  stage.test(`section planes are accessible in the ${colorScheme} theme`, async () => {
    const { page } = await stage.watch({ colorScheme });
    await openTab(page, "scene");
    await page.locator('[data-section="section_planes"] summary').click();
    await page.getByRole("button", { name: "Cut along Z" }).click();
    await soon((all) => all.length === 1, "a plane");
    await page.getByRole("slider", { name: "Position 1" }).scrollIntoViewIfNeeded();
    await screenshot(page, `section_${colorScheme}`);
    assert.deepEqual(await seriousFindings(page), []);
    await call("section.set", { planes: [] });
  });
}
