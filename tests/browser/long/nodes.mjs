// Several servers behind a load balancer: sessions are found on their server, and viewers of a
// failed server continue on another one without affecting its sessions.

import assert from "node:assert/strict";
import { seriousFindings } from "../harness/axe.mjs";
import { Balancer } from "../harness/balancer.mjs";
import {
  distance,
  dragView,
  eventually,
  firstFrame,
  staticCamera,
  screenshot,
} from "../harness/browser.mjs";
import { startServer } from "../harness/server.mjs";
import { Stage } from "../harness/stage.mjs";

const view = { viewport: { width: 720, height: 450 } };
const permissions = ["clipboard-read", "clipboard-write"];
const small = ["--width", "320", "--height", "200"];
const open = new Stage({ view, serverArguments: small });
const [controlToken, viewToken] = ["control-0123456789", "read-only-0123456789"];
const guarded = new Stage({
  view,
  serverArguments: [...small, "--token", controlToken, "--view-token", viewToken],
});

/** A test with a second server, which may be killed, and a load balancer before both. */
function testWithTwo(name, body, stage = open) {
  stage.test(name, async () => {
    const other = await startServer(0, stage.serverArguments);
    const balancer = await new Balancer([stage.server, other], other).start();
    try {
      await body({ stage, here: stage.server, other, balancer });
      await Promise.all([...stage.contexts].map((context) => context.close()));
    } finally {
      balancer.stop();
      await other.stop("SIGKILL");
    }
  });
}

const viewersIn = async (server, session) =>
  (await server.call("session.info", {}, session)).viewers.length;

const missing = (page) => page.locator(".toast", { hasText: "There is no session" });

/** The link that "Copy link to join" puts into the clipboard. */
async function linkToJoin(page) {
  await page.getByRole("button", { name: "Participants" }).click();
  await page.evaluate(() => navigator.clipboard.writeText(""));
  await page.getByRole("button", { name: "Copy link to join" }).click();
  const link = await eventually(
    () => page.evaluate(() => navigator.clipboard.readText()),
    "the link in the clipboard",
  );
  await page.keyboard.press("Escape");
  return link;
}

/** Kills a server and waits until the pages are live on another one. */
async function lose(server, ...pages) {
  await server.stop("SIGKILL");
  for (const page of pages) {
    await page.locator(".toast", { hasText: /server/ }).waitFor({ timeout: 60_000 });
    await firstFrame(page);
  }
}

testWithTwo("a named session is found on the server that its route leads to", async (nodes) => {
  const { stage, here, other, balancer } = nodes;
  balancer.home = here;
  const name = balancer.nameFor(other);
  await other.call("session.create", { name, copy_of: "main" });
  const { page } = await stage.watch({ url: `${balancer.url}?session=${name}`, permissions });
  assert.equal(await missing(page).count(), 0);
  assert.equal(await viewersIn(other, name), 1);
  assert.equal(await viewersIn(here, "main"), 0);
  assert.equal(await linkToJoin(page), `${balancer.url}?session=${name}`);

  const nowhere = await stage.watch({ url: `${balancer.url}?session=nowhere` });
  await missing(nowhere.page).getByText("This is the main session").waitFor();
});

testWithTwo("a link to join leads to the author's own main session", async (nodes) => {
  const { stage, here, other, balancer } = nodes;
  for (const home of [other, here]) {
    balancer.home = home;
    const author = await stage.watch({ url: balancer.url, permissions });
    assert.equal(await viewersIn(home, "main"), 1);
    const link = await linkToJoin(author.page);
    balancer.home = home === here ? other : here; // the server that a guest's cookie would select
    const guest = await stage.watch({ url: link });
    assert.equal(await missing(guest.page).count(), 0);
    assert.equal(await viewersIn(home, "main"), 2, link);
    await guest.page.close();
    await author.page.close();
  }
});

testWithTwo(
  "viewers of a failed server meet in a session of their own on another server",
  async (nodes) => {
    const { stage, here, other, balancer } = nodes;
    const bystander = await stage.watch({ url: here.url });
    await bystander.page.getByRole("button", { name: "Participants" }).click();
    await bystander.page.getByRole("button", { name: "Take exclusive control" }).click();
    await dragView(bystander.page, { x: 200, y: 200 }, { x: 260, y: 230 });
    await staticCamera(bystander.page, here);
    const before = await here.call("session.info");

    const options = { url: balancer.url, expectErrors: true };
    const first = await stage.watch({ ...options, permissions });
    const second = await stage.watch(options);
    await other.call("settings.patch", { patch: { exposure: { compensation: 0.75 } } });
    await dragView(first.page, { x: 100, y: 200 }, { x: 260, y: 230 });
    const { eye } = await staticCamera(first.page, other);
    const { instance } = await other.call("hello");
    const name = `main-${instance.slice(0, 8)}`;

    await lose(other, first.page, second.page);
    const together = async () => (await viewersIn(here, name).catch(() => 0)) === 2;
    await eventually(together, "both viewers in one session");
    await eventually(async () => {
      const camera = await here.call("camera.get", {}, name);
      return distance(camera.eye, eye) < 1e-3;
    }, "their camera");
    const { settings } = await here.call("settings.get", {}, name);
    assert.equal(settings.exposure.compensation, 0.75);
    await screenshot(first.page, "another_node");
    assert.deepEqual(await seriousFindings(first.page), []);

    const after = await here.call("session.info");
    assert.deepEqual(
      [after.rev, after.scene, after.viewers.length, after.control],
      [before.rev, before.scene, 1, "exclusive"],
      "the bystander's session was affected",
    );
    const link = await linkToJoin(first.page);
    assert.equal(link, `${balancer.url}?session=${name}`);
    await eventually(() => first.page.url() === link, "the page's address");
    await first.page.reload();
    await firstFrame(first.page);
    assert.equal(await viewersIn(here, name), 2);
  },
);

testWithTwo("a named session of a failed server is restored under its name", async (nodes) => {
  const { stage, here, other, balancer } = nodes;
  const name = balancer.nameFor(other, "review");
  await other.call("session.create", { name, copy_of: "main" });
  const options = { url: `${balancer.url}?session=${name}`, expectErrors: true };
  const first = await stage.watch(options);
  const second = await stage.watch(options);
  await dragView(first.page, { x: 100, y: 200 }, { x: 260, y: 230 });
  const inside = { call: (method, params) => other.call(method, params, name) };
  const { eye } = await staticCamera(first.page, inside);
  const before = await here.call("session.info");
  await lose(other, first.page, second.page);
  assert.equal(await viewersIn(here, name), 2);
  await eventually(async () => {
    const camera = await here.call("camera.get", {}, name);
    return distance(camera.eye, eye) < 1e-3;
  }, "its camera");
  assert.equal((await here.call("session.info")).rev, before.rev);
});

testWithTwo("motion JPEG is reloaded after an error", async ({ stage, balancer }) => {
  balancer.upgrades = false;
  const { page } = await stage.open({ url: balancer.url, expectErrors: true });
  await page.waitForSelector('#pill[data-state="mjpeg_fallback"]', { timeout: 60_000 });
  const image = page.locator("#mjpeg");
  const shown = () => image.evaluate((node) => !node.hidden && node.naturalWidth > 0);
  await eventually(shown, "a frame");
  const loads = () => balancer.paths.filter((path) => path.includes("stream.mjpg")).length;
  const before = loads();
  balancer.disconnect();
  await eventually(() => loads() > before, "another load");
  await eventually(shown, "a frame again");
});

async function readOnlyViewersFollow({ stage, here, other, balancer }) {
  await here.call("camera.fit"); // so that its main session is in use
  const address = (token) => ({ url: `${balancer.url}?token=${token}`, expectErrors: true });
  const readOnly = await stage.watch(address(viewToken));
  const controller = await stage.watch(address(controlToken));
  const { instance } = await other.call("hello");
  await lose(other, controller.page, readOnly.page);
  assert.equal(await viewersIn(here, `main-${instance.slice(0, 8)}`), 2);
}
testWithTwo(
  "read-only viewers follow the other viewers of a failed server",
  readOnlyViewersFollow,
  guarded,
);
