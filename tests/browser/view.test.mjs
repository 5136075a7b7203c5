// Bookmarks, navigation, animation clips, unknown settings, scene thumbnails.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import {
  distance,
  eventually,
  firstFrame,
  openTab,
  staticCamera,
  screenshot,
  settle,
  setCamera,
} from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({ resolution: "half" });

stage.test("a bookmark is shared by the viewers of a session and moves the camera in a transition", async () => {
  const { page } = await stage.watch();
  const saved = await staticCamera(page, stage.server);
  await page.locator("#view").focus();
  await page.keyboard.press("b");
  await page.getByRole("button", { name: "View 1", exact: true }).waitFor();
  await page.reload();
  await firstFrame(page);
  await setCamera(page, stage.server, { eye: [4, 3, 4] });
  await page.getByRole("button", { name: "View 1", exact: true }).click();
  const back = await staticCamera(page, stage.server);
  assert.ok(distance(back.eye, saved.eye) < 1e-3, `${back.eye} instead of ${saved.eye}`);
  assert.equal(await page.locator(".bookmark-image").count(), 1, "no thumbnail");
  await page.getByRole("button", { name: "Rename View 1" }).click();
  const name = page.getByRole("textbox", { name: "New name of View 1" });
  await name.fill("From above");
  await name.press("Enter");
  await page.getByRole("button", { name: "From above", exact: true }).waitFor();
  const other = await stage.watch();
  await other.page.getByRole("button", { name: "From above", exact: true }).waitFor();
  await screenshot(page, "bookmarks");
  assert.deepEqual(await seriousFindings(page), []);
  await page.getByRole("button", { name: "Remove From above" }).click();
  await page.getByRole("button", { name: "Confirm: remove From above" }).click();
  await page.locator(".bookmark").waitFor({ state: "detached" });
  await other.page.locator(".bookmark").waitFor({ state: "detached" });
});

stage.test("W flies forward, D to the right, and dragging during flight looks around", async () => {
  const { page } = await stage.sharedViewer();
  await setCamera(page, stage.server, { eye: [0, 1, 6], target: [0, 1, 0] });
  await page.locator("#view").focus();
  await page.keyboard.press("w", { delay: 200 });
  const forward = await staticCamera(page, stage.server);
  assert.ok(forward.eye[2] < 5.99 && Math.abs(forward.eye[0]) < 1e-3, `${forward.eye}`);
  await page.keyboard.press("d", { delay: 200 });
  const right = await staticCamera(page, stage.server);
  assert.ok(right.eye[0] > 0.01, `${right.eye}`);
  assert.ok(Math.abs(right.target[0] - right.eye[0]) < 1e-3, "the view turned");
  await page.keyboard.down("e");
  await page.mouse.move(300, 300);
  await page.mouse.down();
  await page.mouse.move(420, 300, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up("e");
  const looked = await staticCamera(page, stage.server);
  assert.ok(looked.eye[1] > right.eye[1], "E did not raise the eye");
  const [deltaX, , deltaZ] = looked.eye.map((value, axis) => value - right.eye[axis]);
  assert.ok(Math.hypot(deltaX, deltaZ) < 0.1, "looking around moved the eye");
  assert.ok(Math.abs(looked.target[0] - looked.eye[0]) > 0.05, "the view did not turn");
});

stage.test("a drag orbits around the point that was clicked", async () => {
  // No inertia, and no questions about what the pointer shows to others.
  const { page } = await stage.watch({ reducedMotion: "reduce", stored: { pointer: "0" } });
  await setCamera(page, stage.server, { eye: [0, 1.5, 6], target: [0, 0.6, 0] });
  const at = { x: 0.25, y: 0.8 };
  const { position } = await stage.server.call("scene.pick", at);
  const { x, y, width, height } = await page.locator("#view").boundingBox();
  await page.mouse.move(x + at.x * width, y + at.y * height);
  await settle(page, stage.server);
  // The drag begins when the server has told the page the point.
  const picks = () => page.evaluate(() => window.seen.answered["scene.pick"] ?? 0);
  const before = await picks();
  await page.mouse.down();
  await eventually(async () => (await picks()) > before, "the clicked point");
  await page.mouse.move(x + at.x * width + 120, y + at.y * height, { steps: 6 });
  await page.mouse.up();
  const { eye } = await staticCamera(page, stage.server);
  assert.ok(Math.hypot(eye[0], eye[2] - 6) > 0.5, `${eye}`);
  await settle(page, stage.server);
  const there = await stage.server.call("scene.pick", at);
  assert.ok(distance(there.position, position) < 0.1, `${there.position}, not ${position}`);
  assert.ok(Math.abs(distance(eye, position) - distance([0, 1.5, 6], position)) < 1e-2);
});

stage.test("a fit leaves the scene beside the panel", async () => {
  const { page } = await stage.sharedViewer();
  await page.locator("#view").focus();
  await page.keyboard.press("f");
  const beside = await staticCamera(page, stage.server);
  await page.keyboard.press("h");
  await page.locator("#view").focus();
  await page.keyboard.press("f");
  await eventually(async () => {
    const whole = await stage.server.call("camera.get");
    return distance(whole.target, beside.target) > 0.1;
  }, "a fit into the whole view");
  await page.keyboard.press("h");
});

stage.test("the wheel zooms towards the pointer", async () => {
  const { page } = await stage.sharedViewer();
  await setCamera(page, stage.server, { eye: [0, 1, 6], target: [0, 1, 0] });
  await page.mouse.move(120, 270);
  await page.mouse.wheel(0, -240);
  const camera = await staticCamera(page, stage.server);
  assert.ok(camera.eye[2] < 5.9 && camera.eye[0] < -0.05, `${camera.eye}`);
});

stage.test("the wheel comes close to a surface and never passes it", async () => {
  const { page } = await stage.sharedViewer();
  await setCamera(page, stage.server, { eye: [0, 1, 6], target: [0, 0.6, 0] });
  const { x, y, width, height } = await page.locator("#view").boundingBox();
  const surface = (await stage.server.call("scene.pick", { x: 0.5, y: 0.5 })).position;
  const far = Math.hypot(...surface.map((value, axis) => value - [0, 1, 6][axis]));
  await page.mouse.move(x + width / 2, y + height / 2);
  for (let i = 0; i < 40; i += 1) {
    await page.mouse.wheel(0, -240);
    await page.waitForTimeout(25);
  }
  const pick = await eventually(async () => {
    const found = await stage.server.call("scene.pick", { x: 0.5, y: 0.5 });
    return found.hit && found.distance < 0.1 * far && found;
  }, "the surface to be close");
  const { eye } = await staticCamera(page, stage.server);
  const off = Math.hypot(...surface.map((value, axis) => value - pick.position[axis]));
  assert.ok(off < 0.05 * far, `${off} m beside the surface`);
  assert.ok(eye[2] > surface[2], `${eye} is behind ${surface}`);
});

stage.test("a clip plays, pauses and seeks", async () => {
  const { page } = await stage.sharedViewer();
  await page.locator("#transport select[name=clip]").selectOption("moving_objects_light");
  await eventually(
    async () => (await stage.server.call("animation.list")).playing,
    "the clip to play",
  );
  assert.equal((await stage.server.call("animation.list")).clip, "moving_objects_light");
  await page.getByRole("button", { name: "Pause" }).click();
  await eventually(async () => !(await stage.server.call("animation.list")).playing, "a pause");
  const scrub = page.getByRole("slider", { name: "Time in the clip" });
  await scrub.evaluate((node) => {
    node.value = "500";
    node.dispatchEvent(new Event("input", { bubbles: true }));
    node.dispatchEvent(new Event("change", { bubbles: true }));
  });
  await eventually(async () => {
    const { seconds, clips, clip } = await stage.server.call("animation.list");
    const { duration } = clips.find(({ name }) => name === clip);
    return Math.abs(seconds - duration / 2) < 0.05;
  }, "the middle of the clip");
  await page.locator("#transport select[name=rate]").selectOption("2");
  await eventually(
    async () => (await stage.server.call("animation.list")).rate === 2,
    "twice the speed",
  );
  await screenshot(page, "transport");
});

stage.test("playback changes of another viewer are shown without polling", async () => {
  const { page } = await stage.sharedViewer();
  const call = (method, params) => stage.server.call(method, params);
  const transport = page.locator("#transport");
  await transport.locator("select[name=clip]").waitFor();
  const requests = () => page.evaluate(() => window.seen.sent["animation.list"] ?? 0);
  const before = await requests();
  const { clips } = await call("animation.play", { clip: "moving_objects_light", rate: 0.5 });
  await transport.getByRole("button", { name: "Pause" }).waitFor();
  assert.equal(await transport.locator("select[name=rate]").inputValue(), "0.5");
  await call("animation.pause");
  await transport.getByRole("button", { name: "Play" }).waitFor();
  const { duration } = clips.find(({ name }) => name === "moving_objects_light");
  const shows = (seconds) =>
    page.waitForFunction(
      ([now, all]) =>
        document.querySelector("#transport .time").textContent ===
          `${now.toFixed(1)} / ${all.toFixed(1)} s` &&
        Math.abs(Number(document.querySelector("#transport input").value) - (1000 * now) / all) < 2,
      [seconds, duration],
    );
  await call("animation.seek", { seconds: duration / 2 });
  await shows(duration / 2);
  assert.equal(await requests(), before, "the page polled the animation");

  // In lockstep a playing clip does not advance between steps.
  await call("frame.step", { frames: 0, dt: 0 });
  await call("animation.play", { rate: 1 });
  await transport.getByRole("button", { name: "Pause" }).waitFor();
  await call("frame.step", { frames: 3, dt: duration / 12 });
  await shows((duration * 3) / 4);
  await call("frame.run");
  await call("animation.pause");
  await transport.getByRole("button", { name: "Play" }).waitFor();
});

stage.test("an unknown setting gets a control", async () => {
  const context = await stage.context();
  await context.addInitScript(() => {
    const parse = JSON.parse;
    JSON.parse = (text, ...rest) => {
      const value = parse(text, ...rest);
      if (value?.result?.properties?.tone_map) {
        value.result.properties.aurora = {
          type: "object",
          title: "Aurora",
          "x-order": 99,
          properties: {
            strength: { type: "number", minimum: 0, maximum: 2, default: 1, description: "Glow." },
            colours: { type: "array", items: { type: "string" }, default: ["green"] },
          },
        };
      }
      return value;
    };
  });
  const { page } = await stage.watch({ context });
  await openTab(page, "settings");
  await page.getByRole("searchbox").fill("aurora");
  const strength = page.locator('[data-path="aurora.strength"]');
  assert.equal(await strength.locator("input[type=range]").count(), 1);
  assert.equal(await page.locator('[data-path="aurora.colours"] input').count(), 1);
  await strength.locator("input.number").fill("1.5");
  await strength.locator("input.number").press("Enter");
  // The server has no such setting: it returns an error, and the page resets the control.
  await page.locator(".toast-text").waitFor({ timeout: 20_000 });
  await screenshot(page, "unknown_setting");
});
