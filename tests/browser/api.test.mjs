// The page at /api: methods of the server's description, examples that run, frame header, errors.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { screenshot } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const permissions = ["clipboard-read", "clipboard-write"];
const stage = new Stage({ view: { viewport: { width: 1280, height: 800 } } });

async function openApi(options = {}) {
  const { page } = await stage.open({ url: new URL("api", stage.server.url).href, ...options });
  await page.locator("#errors table").waitFor();
  return page;
}

stage.test("the API page lists every method, the frame header and the errors", async () => {
  const page = await openApi();
  const { methods, components } = await stage.server.call("rpc.discover");
  const listed = await page
    .locator("article:not([id^=notification])")
    .evaluateAll((articles) => articles.map(({ id }) => id));
  assert.deepEqual([...listed].sort(), methods.map(({ name }) => name).sort());
  const header = page.getByRole("table", { name: "Fields of the frame header" });
  const sequence = header.getByRole("row", { name: /frame_seq/ });
  assert.match(await sequence.textContent(), /frame_seq124counts per viewer/);
  const errors = page.getByRole("table", { name: "Codes of errors" }).locator("tbody tr");
  assert.equal(await errors.count(), Object.keys(components.errors).length);
  await screenshot(page, "api");
  assert.deepEqual(await seriousFindings(page), []);
  await page.getByLabel("Search methods").fill("camera orbit yaw");
  await page.getByText(/^\d+ entr(y|ies)$/).waitFor();
  assert.ok(await page.locator("[id='camera.orbit']").isVisible());
  assert.equal(await page.locator("[id='session.list']").isVisible(), false);
  await page.getByLabel("Search methods").fill("qwertz");
  await page.getByText("Nothing contains these words").waitFor();
});

stage.test("an example runs in the chosen session, and its errors are shown", async () => {
  const page = await openApi({ permissions });
  await stage.server.call("session.create", { name: "mine", copy_of: "main" });
  await page.getByLabel("Session of the examples").fill("mine");
  const example = page.locator("[id='camera.orbit'] form");
  const params = example.getByLabel("Example");
  await params.fill('{"yaw": 30, "pitch": 0}');
  const before = await stage.server.call("camera.get", {}, "mine");
  const shared = await stage.server.call("camera.get");
  await params.press("Control+Enter");
  await example.getByText(/Answered in \d+ ms/).waitFor();
  assert.match(await example.locator("pre").textContent(), /"vertical_fov"/);
  const after = await stage.server.call("camera.get", {}, "mine");
  assert.notDeepEqual(after.eye, before.eye);
  assert.deepEqual(await stage.server.call("camera.get"), shared, "main has changed");

  await params.fill('{"yaw": "far"}');
  await example.getByRole("button", { name: "Run" }).click();
  await example.getByText(/Error -32602 after \d+ ms: yaw/).waitFor();
  await screenshot(page, "api_error");
  await params.fill("{");
  await example.getByRole("button", { name: "Run" }).click();
  await example.getByText(/This is not JSON/).waitFor();

  await params.fill('{"yaw": 5}');
  await example.getByRole("button", { name: "Copy for curl" }).click();
  await example.getByText("Copied for curl").waitFor();
  const curl = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(curl, /"method":"camera.orbit","params":{"yaw":5}.*\/rpc\?session=mine/);
  await example.getByRole("button", { name: "Copy for Python" }).click();
  await example.getByText("Copied for Python").waitFor();
  const python = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(python, /session="mine"[^]*view.camera.orbit\(yaw=5\)/);
});

stage.test("on a phone in light colours the API page does not overflow", async () => {
  const page = await openApi({ viewport: { width: 390, height: 844 }, colorScheme: "light" });
  await screenshot(page, "api_phone");
  const [content, window] = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    innerWidth,
  ]);
  assert.ok(content <= window, `${content} px of content in ${window} px`);
  assert.deepEqual(await seriousFindings(page), []);
});
