// The pages of a server that needs a token, for those who have none or a wrong one.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { eventually, firstFrame, screenshot } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const token = "control-0123456789";
const stage = new Stage({
  serverArguments: ["--token", token],
  view: { viewport: { width: 720, height: 450 } },
});

stage.test("without a token the page asks for one, and says when it is wrong", async () => {
  const view = Buffer.from(JSON.stringify({ scene: "mirror" })).toString("base64url");
  // The browser reports the status 401 itself.
  const { page } = await stage.open({
    url: `${stage.server.url}#view=${view}`,
    expectErrors: true,
  });
  await page.getByText("This server needs an access token.").waitFor();
  await screenshot(page, "token_missing");
  assert.deepEqual(await seriousFindings(page), []);
  const field = page.getByLabel("Access token");
  assert.ok(await field.evaluate((node) => node === document.activeElement));
  await field.fill("wrong-0123456789");
  await field.press("Enter");
  await page.getByRole("alert").getByText("This token is not valid.").waitFor();
  await page.emulateMedia({ colorScheme: "light" });
  await screenshot(page, "token_wrong");
  assert.deepEqual(await seriousFindings(page), []);
  await page.getByLabel("Access token").fill(token);
  await page.getByRole("button", { name: "Continue" }).click();
  await firstFrame(page);
  assert.equal(new URL(page.url()).search, "", "the token is left in the address");
  // The view of the link has survived.
  await eventually(async () => (await page.title()).startsWith("mirror"), "the linked view");
});

stage.test("without a token the API page asks for one and comes back", async () => {
  const url = new URL("api", stage.server.url).href;
  const { page } = await stage.open({ url, expectErrors: true });
  await page.getByLabel("Access token").fill(token);
  await page.getByRole("button", { name: "Continue" }).click();
  await page.getByRole("heading", { name: "camera.orbit" }).waitFor();
  assert.equal(page.url(), url, "the token is left in the address");
});
