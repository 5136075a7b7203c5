// Several viewers, small screens, and a restart of the server.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import {
  distance,
  doubleClick,
  dragView,
  eventually,
  firstFrame,
  ownErrors,
  viewScreenshot,
  staticCamera,
  screenshot,
  settle,
  unfoldAll,
} from "./harness/browser.mjs";
import { inFirefox } from "./harness/environment.mjs";
import { difference, statistics, thumbnail } from "./harness/images.mjs";
import { Stage } from "./harness/stage.mjs";

// Images are compared while nothing changes: they do not gain samples of the path tracer meanwhile.
const stage = new Stage({
  samples: 16,
  resolution: "half",
  serverArguments: ["--set", "reference.use=off"],
});

async function viewImage(page, name) {
  return thumbnail(page, await viewScreenshot(page, name));
}

stage.test("a second viewer follows the camera of the first", async () => {
  const first = await stage.watch();
  const second = await stage.watch();
  await settle(second.page, stage.server);
  const before = await viewImage(second.page, "second_viewer_before");
  assert.ok(statistics(before).deviation > 0.03, "the second viewer's frame is nearly uniform");
  await dragView(first.page, { x: 300, y: 300 }, { x: 560, y: 330 });
  await eventually(
    async () => difference(before, await viewImage(second.page, "second_viewer_after")) > 0.01,
    "a changed frame at the second viewer",
  );
  await staticCamera(first.page, stage.server);
  await first.page.close();
  await settle(second.page, stage.server);
  const alone = await viewImage(second.page, "second_viewer_alone");
  await dragView(second.page, { x: 560, y: 330 }, { x: 300, y: 300 });
  await eventually(
    async () => difference(alone, await viewImage(second.page, "second_viewer_moved")) > 0.01,
    "the second viewer to continue alone",
  );
});

stage.test("a phone that joins leaves the desktop's image as it is", async () => {
  // A drag turns about the point that was clicked if the server tells it in time: where the test
  // before has left the camera there may be nothing to pick.
  await stage.server.call("camera.set", { eye: [0, 8, 8], target: [0, 0, 0] });
  const desktop = await stage.watch();
  await settle(desktop.page, stage.server);
  const before = await viewImage(desktop.page, "desktop_alone");
  const size = ({ width, height }) => `${width} x ${height}`;
  const alone = size(await stage.server.call("session.info"));
  const phone = await stage.watch({ viewport: { width: 390, height: 700 } });
  await settle(phone.page, stage.server);
  assert.equal(size(await stage.server.call("session.info")), alone);
  const change = difference(before, await viewImage(desktop.page, "desktop_with_phone"));
  assert.ok(change < 0.005, `the desktop's image has changed by ${change}`);

  // The phone shows the middle of it, and picks what it shows.
  await viewScreenshot(phone.page, "phone_with_desktop");
  const shownPart = (390 / 700) * (540 / 960); // of the frame's width
  const at = { x: 0.5 + (80 / 390 - 0.5) * shownPart, y: 0.5 };
  const { position } = await stage.server.call("scene.pick", at);
  await doubleClick(phone.page, { x: 80, y: 350 });
  await eventually(async () => {
    const { target } = await stage.server.call("camera.get");
    return distance(target, position) < 0.2;
  }, `the focus at ${position}`);

  await desktop.page.close();
  await eventually(async () => {
    const { width, height } = await stage.server.call("session.info");
    return height > 1.5 * width;
  }, "a size that suits the phone alone");
});

stage.test("a page that joins others leaves the camera that the server has fitted", async () => {
  const desktop = await stage.watch();
  await desktop.page.keyboard.press("h"); // a fit beside the panel would be the page's own
  await stage.server.call("camera.fit");
  await settle(desktop.page, stage.server);
  const { eye } = await stage.server.call("camera.get");
  const phone = await stage.watch({ viewport: { width: 390, height: 700 } });
  await settle(phone.page, stage.server);
  await phone.page.waitForFunction(() => window.seen.answered["bookmarks.list"] > 0);
  assert.deepEqual((await stage.server.call("camera.get")).eye, eye);
});

const openParticipants = (page) => page.getByRole("button", { name: "Participants" }).click();
const participantCount = (page) => page.locator(".participants-count").textContent();

/** Two viewers, the first of which is Ada. */
async function adaAndAnother() {
  const first = await stage.watch({ viewport: { width: 960, height: 540 } });
  const second = await stage.watch({ viewport: { width: 960, height: 540 } });
  await openParticipants(first.page);
  await first.page.getByRole("textbox", { name: "Your name" }).fill("Ada");
  await first.page.getByRole("textbox", { name: "Your name" }).press("Enter");
  await first.page.keyboard.press("Escape");
  for (const { page } of [first, second]) {
    await eventually(async () => (await participantCount(page)) === "2", "two viewers");
  }
  return { ada: first.page, other: second.page };
}

stage.test("a viewer sees what another one points at, with its name", async () => {
  await stage.server.call("camera.fit");
  const { ada, other } = await adaAndAnother();
  await settle(ada, stage.server);
  await ada.mouse.move(300, 330);
  await ada.mouse.move(310, 340, { steps: 3 });
  const label = other.locator(".pointer span");
  await label.waitFor();
  await eventually(async () => (await label.textContent()) === "Ada", "her name");
  const tip = () =>
    other.locator(".pointer").evaluate((node) => {
      const { left, top } = node.getBoundingClientRect();
      return [left, top];
    });
  await eventually(async () => {
    const [x, y] = await tip();
    return Math.hypot(x - 310, y - 340) < 8;
  }, "the arrow at the same place of the view");
  assert.equal(await ada.locator(".pointer").count(), 0, "a pointer of its own");
  await screenshot(other, "pointer");
  await other.emulateMedia({ colorScheme: "light" });
  await screenshot(other, "pointer_light");
  assert.deepEqual(await seriousFindings(other), []);

  // It stays at its point of the scene, and goes with its viewer.
  await stage.server.call("camera.orbit", { yaw: 20 });
  await eventually(async () => Math.hypot((await tip())[0] - 310, (await tip())[1] - 340) > 8, "another place");
  await openParticipants(ada);
  await ada.getByRole("switch", { name: "Show my pointer" }).click();
  await other.locator(".pointer").waitFor({ state: "detached" });
  await ada.keyboard.press("Escape");
  await ada.mouse.move(330, 360, { steps: 3 });
  await openParticipants(ada);
  await ada.getByRole("switch", { name: "Show my pointer" }).click();
  await ada.keyboard.press("Escape");
  assert.equal(await other.locator(".pointer").count(), 0, "it is not shown");
  await ada.mouse.move(310, 340, { steps: 3 });
  await label.waitFor();
  await ada.close();
  await other.locator(".pointer").waitFor({ state: "detached" });
});

stage.test("a viewer follows the camera of one that looks around, until Escape", async () => {
  await stage.server.call("camera.fit");
  const { ada, other } = await adaAndAnother();
  await openParticipants(ada);
  await ada.getByRole("button", { name: "Look around on my own" }).click();
  await ada.locator("#pill", { hasText: "Live, looking around" }).waitFor();
  await openParticipants(other);
  await other.locator(".participant", { hasText: "Ada" }).waitFor();
  assert.deepEqual(await seriousFindings(other), []);
  await other.getByRole("button", { name: "Follow Ada" }).click();
  const following = other.locator("#following");
  await following.getByText("Following Ada").waitFor();
  await screenshot(other, "following");
  assert.deepEqual(await seriousFindings(other), []);

  /** Eyes of the cameras of both: first that of Ada, whose session is older. */
  const eyes = async () => {
    const { sessions } = await stage.server.call("session.list");
    const own = sessions.filter(({ follows }) => follows === "main");
    const number = ({ viewers }) => Number(viewers[0].viewer.slice(1));
    own.sort((a, b) => number(a) - number(b));
    const cameras = own.map(({ name }) => stage.server.call("camera.get", {}, name));
    return (await Promise.all(cameras)).map(({ eye }) => eye);
  };
  const [begun] = await eyes();
  await dragView(ada, { x: 300, y: 300 }, { x: 480, y: 320 });
  await eventually(async () => {
    const [first, second] = await eyes();
    return distance(first, begun) > 0.05 && distance(first, second) < 1e-4;
  }, "both cameras at the same place");
  await other.locator("#view").focus();
  await other.keyboard.press("Escape");
  await following.waitFor({ state: "hidden" });
  await dragView(ada, { x: 480, y: 320 }, { x: 300, y: 300 });
  await eventually(async () => {
    const [first, second] = await eyes();
    return distance(first, second) > 0.05;
  }, "cameras apart");

  for (const end of [
    () => following.getByRole("button", { name: "Stop" }).click(),
    () => other.locator("#view").press("ArrowLeft"),
    async () => {
      await ada.close();
      await other.getByText("Ada has left this view.").waitFor();
    },
  ]) {
    await openParticipants(other);
    await other.getByRole("button", { name: "Follow Ada" }).click();
    await following.getByText("Following Ada").waitFor();
    await end();
    await following.waitFor({ state: "hidden" });
  }
});

/** A swipe with one finger, as touch events. */
async function swipe(page, from, to) {
  const session = await page.context().newCDPSession(page);
  const touch = (type, point) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: point ? [point] : [] });
  await touch("touchStart", from);
  for (let step = 1; step <= 8; step += 1) {
    const part = step / 8;
    await touch("touchMove", {
      x: from.x + (to.x - from.x) * part,
      y: from.y + (to.y - from.y) * part,
    });
    await page.waitForTimeout(20);
  }
  await touch("touchEnd");
}

/** Two fingers that move apart while both move to the right. */
async function pinch(page, middle) {
  const session = await page.context().newCDPSession(page);
  const points = (step) => [
    { x: middle.x - 30 - step * 3, y: middle.y, id: 0 },
    { x: middle.x + 30 + step * 9, y: middle.y, id: 1 },
  ];
  await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: points(0) });
  for (let step = 1; step <= 8; step += 1) {
    await session.send("Input.dispatchTouchEvent", {
      type: "touchMove",
      touchPoints: points(step),
    });
    await page.waitForTimeout(20);
  }
  await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
}

/** The view ends where the sheet begins, and frames have its shape. */
async function viewAboveSheet(page) {
  const [view, sheet] = await Promise.all(
    ["#view", "#panel"].map((selector) => page.locator(selector).boundingBox()),
  );
  assert.ok(view.height > 120, `a view of ${view.height} px`);
  assert.ok(Math.abs(view.y + view.height - sheet.y) <= 1, "the sheet covers the view");
  await eventually(async () => {
    const { width, height } = await stage.server.call("session.info");
    return Math.abs((width * view.height) / (height * view.width) - 1) < 0.03;
  }, "frames of the view's shape");
}

stage.test("on a desktop at 200 % zoom the view is above the panel", async () => {
  // A window of 1280 x 900 pixels.
  const { page } = await stage.watch({
    viewport: { width: 640, height: 450 },
    deviceScaleFactor: 2,
  });
  await page.getByRole("button", { name: "Show panel" }).click();
  await viewAboveSheet(page);
  await screenshot(page, "zoomed");
});

stage.test("on a phone the panel is a sheet and one finger orbits", async (t) => {
  if (inFirefox) {
    t.skip("its driver sends no touch events");
    return;
  }
  const { page } = await stage.watch({
    viewport: { width: 360, height: 740 },
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  await settle(page, stage.server);
  await screenshot(page, "phone");
  const panel = page.locator("#panel");
  const folded = await panel.boundingBox();
  assert.ok(folded.y > 600, "the sheet covers the view initially");

  const eyeBefore = JSON.stringify((await stage.server.call("camera.get")).eye);
  await swipe(page, { x: 120, y: 300 }, { x: 260, y: 320 });
  await eventually(
    async () => JSON.stringify((await stage.server.call("camera.get")).eye) !== eyeBefore,
    "an orbit by finger",
  );
  const before = await staticCamera(page, stage.server);
  await pinch(page, { x: 180, y: 300 });
  await eventually(async () => {
    const { eye, target } = await stage.server.call("camera.get");
    const closer = distance(eye, target) < 0.9 * distance(before.eye, before.target);
    return closer && distance(target, before.target) > 0;
  }, "a pinch to zoom and pan");

  await page.getByRole("button", { name: "Show panel" }).tap();
  await eventually(async () => (await panel.boundingBox()).y < 500, "an open sheet");
  await unfoldAll(page);
  await screenshot(page, "phone_sheet");
  await viewAboveSheet(page);
  const widest = await page.evaluate(() =>
    Math.max(
      document.documentElement.scrollWidth,
      ...[...document.querySelectorAll("#panel *")].map((node) => {
        const box = node.getBoundingClientRect();
        return box.width > 0 ? box.right : 0;
      }),
    ),
  );
  assert.ok(widest <= 360, `the page is ${widest} px wide`);
});

stage.test("without OffscreenCanvas the page draws the frames", async () => {
  const context = await stage.context();
  await context.addInitScript(() => {
    delete HTMLCanvasElement.prototype.transferControlToOffscreen;
  });
  const { page } = await stage.watch({ context });
  await settle(page, stage.server);
  const { deviation } = statistics(await viewImage(page, "drawn_by_page"));
  assert.ok(deviation > 0.03, "the frame is nearly uniform");
});

stage.test(
  "after a restart of the server the page restores scene, settings, camera and bookmarks",
  async () => {
    const { page, pageErrors } = await stage.watch({ expectErrors: true });
    await stage.server.call("settings.patch", { patch: { exposure: { compensation: 0.75 } } });
    const { name: light } = (await stage.server.call("lights.list")).lights[0];
    await stage.server.call("lights.patch", { light, patch: { intensity: 2.25 } });
    await page.waitForFunction(() => window.seen.received["lights.changed"] > 0);
    await dragView(page, { x: 300, y: 300 }, { x: 520, y: 360 });
    const { eye } = await staticCamera(page, stage.server);
    await page.keyboard.press("b");
    await page.getByRole("button", { name: "View 1", exact: true }).waitFor();

    assert.deepEqual(ownErrors(pageErrors), []);
    await stage.server.stop();
    await page.waitForSelector('#pill[data-state="lost"]', { timeout: 20_000 });
    await page.getByText("Connection lost").waitFor();
    await screenshot(page, "connection_lost");
    await stage.restartServer(["--scene", "mirror"]);
    await page.waitForSelector('#pill[data-state="live"]', { timeout: 40_000 });
    await eventually(async () => {
      const camera = await stage.server.call("camera.get").catch(() => null); // no scene yet
      return camera && distance(camera.eye, eye) < 1e-3;
    }, "the camera to be restored");
    // The camera may be there while the scene is seen that is about to replace the server's.
    await eventually(
      async () => (await stage.server.call("scene.list")).current === "shadow_objects",
      "the scene to be restored",
    );
    assert.equal(await stage.server.setting("exposure.compensation"), 0.75);
    assert.equal((await stage.server.call("lights.list")).lights[0].intensity, 2.25);
    const { bookmarks } = await eventually(async () => {
      const list = await stage.server.call("bookmarks.list");
      return list.bookmarks.length > 0 && list;
    }, "the bookmark to be restored");
    assert.equal(bookmarks[0].name, "View 1");
    assert.ok(distance(bookmarks[0].eye, eye) < 1e-3, `${bookmarks[0].eye}`);
    await firstFrame(page);
    await settle(page, stage.server);
    await screenshot(page, "connection_back");
    assert.ok(statistics(await viewImage(page, "after_restart")).deviation > 0.03);
  },
);
