// Several servers behind one address: sessions are found on the server that has them, and who loses
// a server finds a place on another without disturbing anybody there.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { Balancer } from "./harness/balancer.mjs";
import {
  distance,
  dragPicture,
  eventually,
  firstPicture,
  restingCamera,
  screenshot,
} from "./harness/browser.mjs";
import { startServer } from "./harness/server.mjs";
import { Stage } from "./harness/stage.mjs";

const view = { viewport: { width: 720, height: 450 } };
const permissions = ["clipboard-read", "clipboard-write"];
const small = ["--width", "320", "--height", "200"];
const open = new Stage({ view, serverArguments: small });
const [steering, watching] = ["steering-0123456789", "watching-0123456789"];
const guarded = new Stage({
  view,
  serverArguments: [...small, "--token", steering, "--view-token", watching],
});

/** A test with a second server, which may die, and a balancer before both. */
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

const peopleIn = async (server, session) =>
  (await server.call("session.info", {}, session)).viewers.length;

const missing = (page) => page.locator(".toast", { hasText: "There is no session" });

/** The link that "Copy link to join" puts into the clipboard. */
async function linkToJoin(page) {
  await page.getByRole("button", { name: "Who is here" }).click();
  await page.evaluate(() => navigator.clipboard.writeText(""));
  await page.getByRole("button", { name: "Copy link to join" }).click();
  const link = await eventually(
    () => page.evaluate(() => navigator.clipboard.readText()),
    "the link in the clipboard",
  );
  await page.keyboard.press("Escape");
  return link;
}

/** Kills a server and waits until the pages are live again, on another run than before. */
async function lose(server, ...pages) {
  await server.stop("SIGKILL");
  for (const page of pages) {
    await page.locator(".toast", { hasText: "The server" }).waitFor({ timeout: 60_000 });
    await firstPicture(page);
  }
}

testWithTwo("a named session is found on the server that its name leads to", async (nodes) => {
  const { stage, here, other, balancer } = nodes;
  balancer.home = here;
  const name = balancer.nameFor(other);
  await other.call("session.create", { name, copy_of: "main" });
  const { page } = await stage.watch({ url: `${balancer.url}?session=${name}`, permissions });
  assert.equal(await missing(page).count(), 0);
  assert.equal(await peopleIn(other, name), 1);
  assert.equal(await peopleIn(here, "main"), 0);
  assert.equal(await linkToJoin(page), `${balancer.url}?session=${name}`);

  const nowhere = await stage.watch({ url: `${balancer.url}?session=nowhere` });
  await missing(nowhere.page).getByText("this is the main one").waitFor();
});

testWithTwo("a link to join leads to the author's own main session", async (nodes) => {
  const { stage, here, other, balancer } = nodes;
  for (const home of [other, here]) {
    balancer.home = home;
    const author = await stage.watch({ url: balancer.url, permissions });
    assert.equal(await peopleIn(home, "main"), 1);
    const link = await linkToJoin(author.page);
    balancer.home = home === here ? other : here; // where a guest's cookie would lead
    const guest = await stage.watch({ url: link });
    assert.equal(await missing(guest.page).count(), 0);
    assert.equal(await peopleIn(home, "main"), 2, link);
    await guest.page.close();
    await author.page.close();
  }
});

testWithTwo("who loses a server meets again apart from those on the other", async (nodes) => {
  const { stage, here, other, balancer } = nodes;
  const stranger = await stage.watch({ url: here.url });
  await stranger.page.getByRole("button", { name: "Who is here" }).click();
  await stranger.page.getByRole("button", { name: "Only I change things" }).click();
  await dragPicture(stranger.page, { x: 200, y: 200 }, { x: 260, y: 230 });
  await restingCamera(stranger.page, here);
  const before = await here.call("session.info");

  const watching = { url: balancer.url, complaining: true };
  const first = await stage.watch({ ...watching, permissions });
  const second = await stage.watch(watching);
  await other.call("settings.patch", { patch: { exposure: { compensation: 0.75 } } });
  await dragPicture(first.page, { x: 100, y: 200 }, { x: 260, y: 230 });
  const { eye } = await restingCamera(first.page, other);
  const { instance } = await other.call("hello");
  const name = `main-${instance.slice(0, 8)}`;

  await lose(other, first.page, second.page);
  const together = async () => (await peopleIn(here, name).catch(() => 0)) === 2;
  await eventually(together, "both in one session");
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
    "the stranger's session noticed",
  );
  const link = await linkToJoin(first.page);
  assert.equal(link, `${balancer.url}?session=${name}`);
  await eventually(() => first.page.url() === link, "the page's address");
  await first.page.reload();
  await firstPicture(first.page);
  assert.equal(await peopleIn(here, name), 2);
});

testWithTwo("a named session that is gone is there again under its name", async (nodes) => {
  const { stage, here, other, balancer } = nodes;
  const name = balancer.nameFor(other, "review");
  await other.call("session.create", { name, copy_of: "main" });
  const watching = { url: `${balancer.url}?session=${name}`, complaining: true };
  const first = await stage.watch(watching);
  const second = await stage.watch(watching);
  await dragPicture(first.page, { x: 100, y: 200 }, { x: 260, y: 230 });
  const inside = { call: (method, params) => other.call(method, params, name) };
  const { eye } = await restingCamera(first.page, inside);
  const before = await here.call("session.info");
  await lose(other, first.page, second.page);
  assert.equal(await peopleIn(here, name), 2);
  await eventually(async () => {
    const camera = await here.call("camera.get", {}, name);
    return distance(camera.eye, eye) < 1e-3;
  }, "its camera");
  assert.equal((await here.call("session.info")).rev, before.rev);
});

testWithTwo("motion JPEG that breaks is loaded again", async ({ stage, balancer }) => {
  balancer.upgrades = false;
  const { page } = await stage.open({ url: balancer.url, complaining: true });
  await page.waitForSelector('#pill[data-state="mjpeg_fallback"]', { timeout: 60_000 });
  const image = page.locator("#plain");
  const shown = () => image.evaluate((node) => !node.hidden && node.naturalWidth > 0);
  await eventually(shown, "a picture");
  const loads = () => balancer.paths.filter((path) => path.includes("stream.mjpg")).length;
  const before = loads();
  balancer.cut();
  await eventually(() => loads() > before, "another load");
  await eventually(shown, "a picture again");
});

async function watchersFollow({ stage, here, other, balancer }) {
  await here.call("camera.fit"); // so that its main session is somebody's
  const address = (token) => ({ url: `${balancer.url}?token=${token}`, complaining: true });
  const watcher = await stage.watch(address(watching));
  const steerer = await stage.watch(address(steering));
  const { instance } = await other.call("hello");
  await lose(other, steerer.page, watcher.page);
  assert.equal(await peopleIn(here, `main-${instance.slice(0, 8)}`), 2);
}
testWithTwo("who may only watch follows those who lost their server too", watchersFollow, guarded);
