// The TypeScript library by itself, without the web client: bundled, and run in a page of the
// server, whose WebSocket it uses.

import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import test, { after, before } from "node:test";
import { launchBrowser } from "./harness/browser.mjs";
import { startServer } from "./harness/server.mjs";

const repository = new URL("../../", import.meta.url);
const esbuild = createRequire(new URL("web_client/package.json", repository))("esbuild");

let server;
let browser;

before(async () => {
  server = await startServer();
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

test("a program connects, gets pictures of the size it asks for and hears refusals", async () => {
  const { outputFiles } = await esbuild.build({
    entryPoints: [fileURLToPath(new URL("protocol/typescript/client.ts", repository))],
    bundle: true,
    write: false,
    format: "iife",
    globalName: "heliograph",
  });
  const page = await browser.newPage();
  await page.goto(new URL("icon.svg", server.url).href);
  await page.evaluate(`${outputFiles[0].text}; window.heliograph = heliograph; 0`);
  const seen = await page.evaluate(
    async (url) => {
      const { HeliographClient } = window.heliograph;
      const sizes = [];
      let enough;
      const done = new Promise((resolve) => (enough = resolve));
      const client = await HeliographClient.connect(url, {
        frame: ({ width, height }, jpeg) => {
          sizes.push({ width, height, start: [...jpeg.subarray(0, 2)] });
          if (width === 320) enough();
        },
      });
      await client.configureStream({ width: 320, height: 180, quality: 70 });
      const refusal = await client
        .request("settings.patch", { patch: { exposure: { compensation: 99 } } })
        .catch(({ code, data }) => ({ code, path: data.path }));
      await done;
      client.close();
      return { protocol: client.hello.protocol, last: sizes.at(-1), refusal };
    },
    server.url.replace("http", "ws") + "ws",
  );
  assert.equal(seen.protocol, "heliograph.v1");
  assert.deepEqual(seen.last, { width: 320, height: 180, start: [0xff, 0xd8] });
  assert.deepEqual(seen.refusal, { code: -32602, path: "exposure.compensation" });
});
