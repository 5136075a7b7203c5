// Several people in one session: who may change things, what the others see of it, and who may
// only watch.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import {
  distance,
  dragPicture,
  eventually,
  firstPicture,
  openTab,
  restingCamera,
  screenshot,
  unfoldAll,
} from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const [steering, watching] = ["steering-0123456789", "watching-0123456789"];

const stage = new Stage({
  serverArguments: ["--token", steering, "--view-token", watching],
  view: { viewport: { width: 900, height: 700 } },
});

const addressWith = (token) => new URL(`?token=${token}`, stage.server.url).href;

async function watch(token = steering) {
  return stage.watch({ url: addressWith(token) });
}

/** Controls that could be worked although nothing may be changed. */
function usable(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll(".changeable :is(input, select, button)")]
      .filter((node) => !node.matches(":disabled"))
      .map((node) => node.getAttribute("aria-label") ?? node.name ?? node.textContent),
  );
}

async function expectNothingChanges({ page }) {
  const { eye } = await restingCamera(page, stage.server);
  const { rev } = await stage.server.call("session.info");
  await dragPicture(page, { x: 100, y: 400 }, { x: 260, y: 420 });
  await page.mouse.dblclick(200, 400);
  await page.locator("#view").focus();
  for (const key of ["f", "w", "ArrowLeft", " ", "Control+z"]) await page.keyboard.press(key);
  await openTab(page, "scene");
  await page.getByRole("slider", { name: "Direction of the sun" }).press("ArrowLeft");
  assert.deepEqual(await usable(page), []);
  // What was sent before this answer has been dealt with when it comes.
  await page.getByRole("button", { name: "Help" }).click();
  await page.keyboard.press("Escape");
  assert.deepEqual((await restingCamera(page, stage.server)).eye, eye);
  assert.equal((await stage.server.call("session.info")).rev, rev);
  assert.equal(await page.locator(".toast").count(), 0, "a toast instead of an explanation");
}

stage.test("viewers see who is here, take control, hand it over and free it", async () => {
  const first = await watch();
  const second = await watch();
  const open = ({ page }) => page.getByRole("button", { name: "Who is here" }).click();
  await eventually(
    async () => (await first.page.locator(".people-count").textContent()) === "2",
    "two viewers",
  );
  await open(first);
  await first.page.getByRole("textbox", { name: "Your name" }).fill("Ada");
  await first.page.getByRole("textbox", { name: "Your name" }).press("Enter");
  await open(second);
  await second.page.locator(".person", { hasText: "Ada" }).waitFor();
  await first.page.getByRole("button", { name: "Only I change things" }).click();
  await second.page.locator(".in-control").waitFor();
  await screenshot(second.page, "people");
  assert.deepEqual(await seriousFindings(second.page), []);
  await open(second);

  const note = second.page.locator(".control-note");
  await note.getByText("Ada is in control").waitFor();
  await second.page.locator("#pill", { hasText: "Ada is in control" }).waitFor();
  await unfoldAll(second.page);
  await screenshot(second.page, "without_control");
  await expectNothingChanges(second);

  if (await first.page.locator("#people-card").isHidden()) await open(first);
  const { eye } = await stage.server.call("camera.get");
  await first.page.getByRole("button", { name: "Hand over to" }).click();
  await note.waitFor({ state: "hidden" });
  await dragPicture(second.page, { x: 100, y: 300 }, { x: 260, y: 320 });
  await eventually(
    async () => distance((await stage.server.call("camera.get")).eye, eye) > 0.01,
    "a camera moved by the second viewer",
  );

  await second.page.close();
  const take = first.page.locator(".control-note").getByRole("button", { name: "Take control" });
  await take.click();
  await first.page.locator(".control-note").waitFor({ state: "hidden" });
  assert.notDeepEqual(await usable(first.page), []);
});

stage.test("who may only watch is told so and can change nothing", async () => {
  const { page } = await watch(watching);
  await page.locator(".control-note").getByText("You are here to watch").waitFor();
  await page.locator("#pill", { hasText: "Live, to watch" }).waitFor();
  await screenshot(page, "watching");
  await expectNothingChanges({ page });
  await openTab(page, "inspect");
  assert.ok(await page.locator("[data-section=compare]").isHidden(), "a session cannot be made");
  await page.getByRole("switch", { name: "Inspect pixels" }).click();
  await page.mouse.click(200, 500);
  await page.locator(".pixel-values dd").first().waitFor({ timeout: 60_000 });
  await page.getByRole("button", { name: "Who is here" }).click();
  for (const name of ["Only I change things", "Take control"]) {
    assert.equal(await page.getByRole("button", { name }).count(), 0, name);
  }
});

stage.test("a link leads watchers to what is there, with a word about the rest", async () => {
  const steered = await watch();
  const { eye } = await restingCamera(steered.page, stage.server);
  const view = Buffer.from(JSON.stringify({ camera: { eye: [9, 9, 9] }, settings: {} }));
  const context = await stage.context();
  await (await stage.open({ url: addressWith(watching), context })).page.close();
  const url = `${stage.server.url}#view=${view.toString("base64url")}`;
  const { page } = await stage.open({ url, context });
  await firstPicture(page);
  await page.locator(".toast", { hasText: "The view of the link is not shown" }).waitFor();
  assert.deepEqual((await stage.server.call("camera.get")).eye, eye);
});
