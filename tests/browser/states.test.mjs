// Notices while no frame is shown: one test for each state.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { firstFrame, prepareWorker, screenshot, settle } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const view = { viewport: { width: 720, height: 450 } };
const bright = { ...view, colorScheme: "light" };
const limited = new Stage({ serverArguments: ["--max-viewers", "1"], view });
const stage = new Stage({ view });

const stateOf = (page) => page.locator("#pill").getAttribute("data-state");

limited.test("a full server is reported, and joined when a viewer leaves", async () => {
  const first = await limited.watch();
  const { page } = await limited.open({ expectErrors: true });
  await page.locator('#pill[data-state="full"]').waitFor();
  await page.getByText("The server is full").waitFor();
  await screenshot(page, "full");
  assert.deepEqual(await seriousFindings(page), []);
  await page.getByRole("button", { name: "Retry now" }).click();
  await page.locator('#pill[data-state="full"]').waitFor();
  // From here on the page joins by itself as soon as it may.
  await first.page.close();
  await firstFrame(page);
  assert.equal(await stateOf(page), "live");
});

stage.test("a version mismatch is reported", async () => {
  const context = await stage.context(bright);
  await context.route("**/app.js", async (route) => {
    const response = await route.fetch();
    const body = (await response.text()).replaceAll("heliograph.v1", "heliograph.v0");
    await route.fulfill({ response, body });
  });
  const { page } = await stage.open({ context, expectErrors: true });
  await page.locator('#pill[data-state="wrong_version"]').waitFor();
  await page.getByRole("heading", { name: "Page out of date" }).waitFor();
  await screenshot(page, "wrong_version");
  assert.deepEqual(await seriousFindings(page), []);
});

stage.test('a rejected hello shows "No access"', async () => {
  const context = await stage.context();
  // The page itself needs a token; one that is revoked later makes hello fail.
  await context.addInitScript(() => {
    const parse = JSON.parse;
    JSON.parse = (text, ...rest) => {
      const value = parse(text, ...rest);
      if (value?.result?.protocol) {
        delete value.result;
        value.error = { code: -32001, message: "the token is not valid any more" };
      }
      return value;
    };
  });
  const { page } = await stage.open({ context });
  await page.locator('#pill[data-state="forbidden"]').waitFor();
  await page.getByText("The token is not valid any more.").waitFor();
  assert.equal(await page.locator("#participants").isVisible(), false);
  await screenshot(page, "no_access");
  assert.deepEqual(await seriousFindings(page), []);
});

stage.test("a loading scene shows its name, progress and thumbnail", async () => {
  const { page } = await stage.watch();
  await settle(page, stage.server);
  const { scenes, current } = await stage.server.call("scene.list");
  const other = scenes.find(({ name }) => name !== current).name;
  // Loading is fast here, so the notices are recorded.
  await page.evaluate(() => {
    window.notices = [];
    const card = document.querySelector("#notice");
    new MutationObserver(() => {
      if (!card.hidden) window.notices.push(card.querySelector("h1").textContent);
    }).observe(card, { attributes: true, childList: true, subtree: true, characterData: true });
  });
  await page.locator("select[name=scene]").selectOption(other);
  await page.waitForFunction((name) => document.title.startsWith(name), other);
  assert.ok((await page.evaluate(() => window.notices)).includes(`Loading ${other}…`));
});

stage.test("the old scene stays dimmed until the first frame of the new one", async () => {
  const context = await stage.context();
  // Frames take longer than the answers that tell which of them is awaited.
  await prepareWorker(
    context,
    `const post = self.postMessage;
     self.postMessage = (message, ...rest) => {
       const isFrame = message.kind === "drawn" || message.kind === "decoded";
       if (isFrame) setTimeout(() => post.call(self, message, ...rest), 500);
       else post.call(self, message, ...rest);
     };`,
  );
  const { page } = await stage.watch({ context });
  await settle(page, stage.server);
  const { current } = await stage.server.call("scene.list");
  const { rev } = await stage.server.call("camera.get");
  await page.evaluate(() => {
    window.ends = [];
    const card = document.querySelector("#notice");
    const seen = { hidden: true };
    new MutationObserver(() => {
      if (card.hidden && !seen.hidden) {
        window.ends.push({ rev: window.seen.frame.stateRev, title: document.title, ...seen });
      }
      Object.assign(seen, { hidden: card.hidden, dims: card.classList.contains("dims") });
      if (!card.hidden) seen.last = card.querySelector("p").textContent;
    }).observe(card, { attributes: true, childList: true, subtree: true, characterData: true });
  });
  const other = current === "mirror" ? "shadow_objects" : "mirror";
  await page.locator("select[name=scene]").selectOption(other);
  await page.waitForFunction(() => window.ends.length > 0, undefined, { timeout: 60_000 });
  const [end] = await page.evaluate(() => window.ends);
  assert.match(end.title, new RegExp(`^${other}`));
  assert.ok(end.dims, "the old scene was not dimmed");
  assert.equal(end.last, "Rendering the first frame");
  assert.ok(end.rev > rev, `shown ${end.rev}, the old scene had ${rev}`);
});

stage.test("a load that is cancelled says so, and is no error", async () => {
  const { page } = await stage.watch();
  const { current } = await stage.server.call("scene.list");
  await page.evaluate(() => {
    const card = document.querySelector("#notice");
    new MutationObserver(() => {
      const cancel = card.querySelector("button");
      if (!card.hidden && cancel.textContent === "Cancel") cancel.click();
    }).observe(card, { attributes: true, childList: true, subtree: true, characterData: true });
  });
  await page.locator("select[name=scene]").selectOption("glossy_sponza_1");
  const toast = page.locator(".toast", { hasText: "Cancelled: glossy_sponza_1 was not loaded." });
  await toast.waitFor({ timeout: 60_000 });
  assert.equal(await toast.getAttribute("role"), null);
  assert.equal(await page.locator("[role=alert]").count(), 0);
  assert.equal((await stage.server.call("scene.list")).current, current);
  await page.locator("#notice").waitFor({ state: "hidden" });
});

stage.test("the first frame of a new page has the requested size", async () => {
  const { page: wide } = await stage.watch({ viewport: { width: 900, height: 300 } });
  await wide.close();
  const context = await stage.context({ viewport: { width: 400, height: 400 } });
  await context.addInitScript(() => {
    window.shapes = [];
    const handler = Object.getOwnPropertyDescriptor(Worker.prototype, "onmessage");
    Object.defineProperty(Worker.prototype, "onmessage", {
      set(listener) {
        handler.set.call(this, (event) => {
          const { kind, frame } = event.data;
          if (kind === "drawn") window.shapes.push(frame.width / frame.height);
          listener(event);
        });
      },
    });
  });
  const { page } = await stage.watch({ context });
  await settle(page, stage.server);
  const shapes = await page.evaluate(() => window.shapes);
  assert.ok(shapes.length > 0 && shapes.every((shape) => Math.abs(shape - 1) < 0.05), `${shapes}`);
});
