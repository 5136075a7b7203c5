// The TypeScript library without the web client: bundled, and run in a page of the server, whose
// WebSocket it uses.

import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";
import { Stage } from "../harness/stage.mjs";

const repository = new URL("../../../", import.meta.url);
const esbuild = createRequire(new URL("web_client/package.json", repository))("esbuild");

const stage = new Stage({ scene: "mirror" });

stage.test("a program connects, gets frames of the requested size, and errors", async () => {
  const { outputFiles } = await esbuild.build({
    entryPoints: [fileURLToPath(new URL("protocol/typescript/client.ts", repository))],
    bundle: true,
    write: false,
    format: "iife",
    globalName: "heliograph",
  });
  const page = await (await stage.context()).newPage();
  await page.goto(new URL("icon.svg", stage.server.url).href);
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
      const rejection = await client
        .request("settings.patch", { patch: { exposure: { compensation: 99 } } })
        .catch(({ code, data }) => ({ code, path: data.path }));
      await done;
      client.close();
      return { protocol: client.hello.protocol, last: sizes.at(-1), rejection };
    },
    stage.server.url.replace("http", "ws") + "ws",
  );
  assert.equal(seen.protocol, "heliograph.v1");
  assert.deepEqual(seen.last, { width: 320, height: 180, start: [0xff, 0xd8] });
  assert.deepEqual(seen.rejection, { code: -32602, path: "exposure.compensation" });
});
