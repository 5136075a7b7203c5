// Several viewers in one session: exclusive control, handing it over, read-only access.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import {
  distance,
  doubleClick,
  dragView,
  eventually,
  firstFrame,
  openTab,
  staticCamera,
  screenshot,
  unfoldAll,
} from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const [controlToken, viewToken] = ["control-0123456789", "read-only-0123456789"];

const stage = new Stage({
  serverArguments: ["--token", controlToken, "--view-token", viewToken],
  view: { viewport: { width: 900, height: 700 } },
});

const addressWith = (token) => new URL(`?token=${token}`, stage.server.url).href;

async function watch(token = controlToken) {
  return stage.watch({ url: addressWith(token) });
}

/** The controls that are enabled. */
function enabledControls(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll(".requires-control :is(input, select, button)")]
      .filter((node) => !node.matches(":disabled"))
      .map((node) => node.getAttribute("aria-label") ?? node.name ?? node.textContent),
  );
}

async function expectNothingChanges({ page }) {
  const { eye } = await staticCamera(page, stage.server);
  const { rev } = await stage.server.call("session.info");
  await dragView(page, { x: 100, y: 400 }, { x: 260, y: 420 });
  await doubleClick(page, { x: 200, y: 400 });
  await page.locator("#view").focus();
  for (const key of ["f", "w", "ArrowLeft", " ", "Control+z"]) await page.keyboard.press(key);
  await openTab(page, "scene");
  await page.getByRole("slider", { name: "Direction of the sun" }).press("ArrowLeft");
  assert.deepEqual(await enabledControls(page), []);
  // Messages that were sent before this response have been processed when it arrives.
  await page.getByRole("button", { name: "Help" }).click();
  await page.keyboard.press("Escape");
  assert.deepEqual((await staticCamera(page, stage.server)).eye, eye);
  assert.equal((await stage.server.call("session.info")).rev, rev);
  assert.equal(await page.locator(".toast").count(), 0, "an error toast");
}

stage.test("viewers see participants, take control, hand it over and release it", async () => {
  const first = await watch();
  const second = await watch();
  const open = ({ page }) => page.getByRole("button", { name: "Participants" }).click();
  await eventually(
    async () => (await first.page.locator(".participants-count").textContent()) === "2",
    "two viewers",
  );
  await open(first);
  await first.page.getByRole("textbox", { name: "Your name" }).fill("Ada");
  await first.page.getByRole("textbox", { name: "Your name" }).press("Enter");
  await open(second);
  await second.page.locator(".participant", { hasText: "Ada" }).waitFor();
  await first.page.getByRole("button", { name: "Take exclusive control" }).click();
  await second.page.locator(".in-control").waitFor();
  await screenshot(second.page, "participants");
  assert.deepEqual(await seriousFindings(second.page), []);
  await open(second);

  const note = second.page.locator(".control-note");
  await note.getByText("Ada is in control").waitFor();
  await second.page.locator("#pill", { hasText: "Ada is in control" }).waitFor();
  await unfoldAll(second.page);
  await screenshot(second.page, "without_control");
  await expectNothingChanges(second);

  if (await first.page.locator("#participants-card").isHidden()) await open(first);
  const { eye } = await stage.server.call("camera.get");
  await first.page.getByRole("button", { name: "Hand over to" }).click();
  await note.waitFor({ state: "hidden" });
  await dragView(second.page, { x: 100, y: 300 }, { x: 260, y: 320 });
  await eventually(
    async () => distance((await stage.server.call("camera.get")).eye, eye) > 0.01,
    "a camera moved by the second viewer",
  );

  await second.page.close();
  const take = first.page.locator(".control-note").getByRole("button", { name: "Take control" });
  await take.click();
  await first.page.locator(".control-note").waitFor({ state: "hidden" });
  assert.notDeepEqual(await enabledControls(first.page), []);
});

stage.test("a read-only viewer is informed and cannot change anything", async () => {
  const { page } = await watch(viewToken);
  await page.locator(".control-note").getByText("View only: you can't change anything.").waitFor();
  await page.locator("#pill", { hasText: "Live, view only" }).waitFor();
  await screenshot(page, "read_only");
  await expectNothingChanges({ page });
  await openTab(page, "inspect");
  assert.ok(
    await page.locator("[data-section=compare]").isHidden(),
    "a read-only viewer cannot create sessions",
  );
  await page.getByRole("switch", { name: "Inspect pixels" }).click();
  await page.mouse.click(200, 500);
  await page.locator(".pixel-values dd").first().waitFor({ timeout: 60_000 });
  await page.getByRole("button", { name: "Participants" }).click();
  for (const name of ["Take exclusive control", "Take control"]) {
    assert.equal(await page.getByRole("button", { name }).count(), 0, name);
  }
});

stage.test("a viewer looks around on its own, also with a view token", async () => {
  const controller = await watch();
  const { page } = await watch(viewToken);
  const shared = await staticCamera(controller.page, stage.server);
  await page.getByRole("button", { name: "Participants" }).click();
  await page.getByRole("button", { name: "Look around on my own" }).press("Enter");
  const note = page.locator(".control-note");
  await note.getByText("You look around on your own.").waitFor();
  await page.locator("#pill", { hasText: "Live, looking around" }).waitFor();
  const { sessions } = await stage.server.call("session.list");
  const { name } = sessions.find(({ follows }) => follows === "main");
  const own = () => stage.server.call("camera.get", {}, name);
  assert.deepEqual((await own()).eye, shared.eye);
  await page.locator("#view").focus();
  await page.keyboard.press("ArrowLeft", { delay: 100 });
  await eventually(
    async () => distance((await own()).eye, shared.eye) > 0.05,
    "a movement of the own camera",
  );
  assert.deepEqual((await stage.server.call("camera.get")).eye, shared.eye);
  assert.deepEqual(await enabledControls(page), [], "more than the camera can be changed");

  // What others change is followed.
  await stage.server.call("settings.patch", { patch: { exposure: { compensation: 1 } } });
  const entry = page.locator('[data-path="exposure.compensation"] input.number');
  await eventually(async () => (await entry.inputValue()) === "1", "the exposure");
  await stage.server.call("settings.patch", { patch: { exposure: null } });
  await screenshot(page, "looking_around");
  assert.deepEqual(await seriousFindings(page), []);

  await note.getByRole("button", { name: "Follow again" }).click();
  await note.getByText("View only: you can't change anything.").waitFor();
  await stage.server.call("camera.set", { eye: [3, 2, 5] });
  await page.waitForFunction(() => window.seen.camera?.eye[0] === 3);
  assert.equal((await stage.server.call("session.list")).sessions.length, 1);
});

stage.test(
  "a link does not change the session for a read-only viewer, who is informed",
  async () => {
    const controller = await watch();
    const { eye } = await staticCamera(controller.page, stage.server);
    const view = Buffer.from(JSON.stringify({ camera: { eye: [9, 9, 9] }, settings: {} }));
    const context = await stage.context();
    await (await stage.open({ url: addressWith(viewToken), context })).page.close();
    const url = `${stage.server.url}#view=${view.toString("base64url")}`;
    const { page } = await stage.open({ url, context });
    await firstFrame(page);
    await page.locator(".toast", { hasText: "The view in the link was not applied" }).waitFor();
    assert.deepEqual((await stage.server.call("camera.get")).eye, eye);
  },
);
