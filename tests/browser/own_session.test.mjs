// Links open a session of their own; joining the shared one is explicit, and its viewers are told
// who changed what.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import {
  chooseOutput,
  distance,
  eventually,
  firstFrame,
  openTab,
  screenshot,
  setCamera,
  settle,
} from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const view = { viewport: { width: 900, height: 640 } };
const stage = new Stage({ view });
const crowded = new Stage({ view, serverArguments: ["--max-sessions", "1"] });

const call = (method, params, session) => stage.server.call(method, params, session);

/** The page's URL with a view in its fragment. */
function linkTo(server, state, query = "") {
  const text = Buffer.from(JSON.stringify(state)).toString("base64url");
  return `${server.url}${query}#view=${text}`;
}

async function otherSessions() {
  const { sessions } = await call("session.list");
  return sessions.filter(({ name }) => name !== "main");
}

const ownSession = () => eventually(async () => (await otherSessions())[0], "a session of its own");

/** The directional light and the second material, as a session has them. */
async function editedParts(session) {
  const { lights } = await call("lights.list", {}, session);
  const { materials } = await call("materials.list", {}, session);
  return { sun: lights.find(({ type }) => type === "directional"), material: materials[1] };
}

async function openParticipants(page) {
  await page.getByRole("button", { name: "Participants" }).click();
  return page.locator("#participants-card");
}

stage.test("a copied link restores its view in a session of its own", async () => {
  const permissions = ["clipboard-read", "clipboard-write"];
  const { page } = await stage.watch({ permissions });
  await call("settings.patch", { patch: { tone_map: { curve: "agx" } } });
  await setCamera(page, stage.server, { eye: [1, 2, 6], target: [0, 1, 0], vertical_fov: 40 });
  const { sun, material } = await editedParts();
  const light = { intensity: 2.5, direction: [0.6, -0.8, 0] };
  await call("lights.patch", { light: sun.name, patch: light });
  await call("materials.patch", { material: material.name, patch: { roughness: 0.7 } });
  // A reloaded page reads the changes from the server.
  await page.reload();
  await firstFrame(page);
  const intensity = page
    .locator("[data-section=lights]")
    .getByRole("textbox", { name: "Intensity" });
  await eventually(async () => (await intensity.inputValue()) === "2.5", "the light to be read");
  await chooseOutput(page, "Copy link");
  const link = await eventually(async () => {
    const text = await page.evaluate(() => navigator.clipboard.readText());
    return text.includes("#view=") && text;
  }, "the link in the clipboard");

  await call("settings.patch", { patch: { tone_map: null } });
  await call("scene.load", { name: "mirror" });
  const before = await call("session.info");
  const other = await stage.watch({ url: link });
  const { name } = await ownSession();
  await eventually(async () => {
    const { eye } = await call("camera.get", {}, name);
    return distance(eye, [1, 2, 6]) < 1e-3;
  }, "the camera of the link");
  assert.equal((await call("scene.list", {}, name)).current, "shadow_objects");
  const { settings } = await call("settings.get", {}, name);
  assert.equal(settings.tone_map.curve, "agx");
  const there = await editedParts(name);
  assert.ok(Math.abs(there.sun.intensity - 2.5) < 1e-4 && there.sun.direction[0] > 0.59);
  assert.ok(Math.abs(there.material.roughness - 0.7) < 1e-4);
  await other.page.locator("#pill", { hasText: "your own session" }).waitFor();

  // The shared session did not notice.
  const after = await call("session.info");
  assert.equal(after.rev, before.rev);
  assert.equal(after.scene, "mirror");
  assert.deepEqual(
    after.viewers.map(({ viewer }) => viewer),
    before.viewers.map(({ viewer }) => viewer),
  );
});

stage.test("a reload returns to the own session, and its changes are still there", async () => {
  const url = linkTo(stage.server, { scene: "mirror", settings: {} });
  const { page } = await stage.watch({ url });
  const { name } = await ownSession();
  await call("settings.patch", { patch: { exposure: { compensation: 1.5 } } }, name);
  await page.reload();
  await firstFrame(page);
  assert.deepEqual(
    (await otherSessions()).map((session) => session.name),
    [name],
  );
  const { settings } = await call("settings.get", {}, name);
  assert.equal(settings.exposure.compensation, 1.5);

  // A reload after the session has ended opens the view of the link again.
  await page.goto("about:blank");
  await call("session.close", { session: name });
  await page.goBack();
  await firstFrame(page);
  const again = await ownSession();
  assert.notEqual(again.name, name);
  assert.equal(again.scene, "mirror");
});

stage.test("joining the shared session is explicit, and ends the own one", async () => {
  await call("scene.load", { name: "shadow_objects" });
  const url = linkTo(stage.server, { scene: "mirror", settings: {} });
  const { page } = await stage.watch({ url });
  await ownSession();
  const card = await openParticipants(page);
  await card.getByText("Only you see what you change.").waitFor();
  await screenshot(page, "own_session");
  assert.deepEqual(await seriousFindings(page), []);
  await card.getByRole("button", { name: "Join the shared session" }).press("Enter");
  await page.waitForFunction(() => document.title.startsWith("shadow_objects"));
  await firstFrame(page);
  assert.equal((await call("session.info")).viewers.length, 1);
  await eventually(async () => (await otherSessions()).length === 0, "the own session to end");
  assert.equal(new URL(page.url()).hash, "");
});

stage.test("a copy of the shared session is changed without changing the original", async () => {
  const { page } = await stage.watch();
  await call("settings.patch", { patch: { exposure: { compensation: 1 } } });
  const card = await openParticipants(page);
  await card.getByRole("button", { name: "Open a copy of your own" }).click();
  const { name, scene } = await ownSession();
  assert.equal(scene, (await call("session.info")).scene);
  await page.locator("#pill", { hasText: "your own session" }).waitFor();
  await firstFrame(page);
  const entry = page.locator('[data-path="exposure.compensation"] input.number');
  assert.equal(await entry.inputValue(), "1");
  await entry.fill("2");
  await entry.press("Enter");
  await eventually(async () => {
    const { settings } = await call("settings.get", {}, name);
    return settings.exposure.compensation === 2;
  }, "the change in the copy");
  assert.equal(await stage.server.setting("exposure.compensation"), 1);
  await call("settings.patch", { patch: { exposure: null } });
});

stage.test("a link into a session opens a copy of that session", async () => {
  await call("session.create", { name: "review", scene: "mirror" });
  const patch = { exposure: { compensation: -1 } };
  await call("settings.patch", { patch }, "review");
  const url = linkTo(stage.server, { camera: undefined }, "?session=review");
  const { page } = await stage.watch({ url });
  const sessions = await otherSessions();
  assert.equal(sessions.length, 2);
  assert.deepEqual(sessions.find(({ name }) => name === "review").viewers, []);
  const own = sessions.find(({ name }) => name !== "review");
  assert.equal(own.scene, "mirror");
  await (
    await openParticipants(page)
  )
    .getByRole("button", { name: "Join the shared session" })
    .click();
  await eventually(async () => {
    const { viewers } = await call("session.info", {}, "review");
    return viewers.length === 1;
  }, "the page in the session of the link");
});

stage.test("a link to a scene that the server lacks says so and offers others", async () => {
  const url = linkTo(stage.server, { scene: "nowhere", settings: {} });
  const { page } = await stage.open({ url });
  await page.getByRole("heading", { name: "No scene loaded" }).waitFor({ timeout: 60_000 });
  await page.locator(".toast", { hasText: "nowhere" }).waitFor();
  await openTab(page, "scene");
  await page.locator("select[name=scene]").selectOption("mirror");
  await firstFrame(page);
  assert.equal((await ownSession()).scene, "mirror");
});

crowded.test("a server without room for sessions shows the shared one, unchanged", async () => {
  const { rev } = await crowded.server.call("session.info");
  const url = linkTo(crowded.server, { scene: "mirror", settings: {} });
  const { page } = await crowded.watch({ url });
  await page.locator(".toast", { hasText: "has no room for a session of your own" }).waitFor();
  assert.equal((await crowded.server.call("session.info")).scene, "shadow_objects");
  assert.ok((await crowded.server.call("settings.get")).rev >= rev);
});

stage.test("the other viewers of a shared session are told who changed what", async () => {
  await call("scene.load", { name: "shadow_objects" });
  const first = await stage.watch();
  const second = await stage.watch();
  const names = await openParticipants(first.page);
  await names.getByRole("textbox", { name: "Your name" }).fill("Ada");
  await names.getByRole("textbox", { name: "Your name" }).press("Enter");
  await first.page.keyboard.press("Escape");
  const toast = (text) => second.page.locator(".toast", { hasText: text });

  const card = await openParticipants(second.page);
  await card.getByText("Ada").waitFor();
  await openTab(first.page, "scene");
  const entry = first.page.locator('[data-path="exposure.compensation"] input.number');
  await entry.fill("0.5");
  await entry.press("Enter");
  await toast("Ada changed exposure (EV)").waitFor();
  await card.locator(".deed", { hasText: "changed exposure (EV)" }).waitFor();
  await first.page.locator("select[name=scene]").selectOption("mirror");
  await toast("Ada loaded mirror").waitFor();
  assert.equal(await second.page.locator(".toast").count(), 1, "one message per viewer");
  await settle(second.page, stage.server);
  await screenshot(second.page, "told_who");
  assert.deepEqual(await seriousFindings(second.page), []);
  await call("settings.patch", { patch: { exposure: null } });
});
