// The TypeScript library against a real server: run directly where Node supports TypeScript, bundled
// otherwise; with Node's WebSocket class if it has one, otherwise that of ws.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import ws from "ws";

const url = process.env.HELIOGRAPH_TEST_URL;
const token = process.env.HELIOGRAPH_TEST_TOKEN;
const webSocket = globalThis.WebSocket ?? ws;

const repository = new URL("../../../", import.meta.url);
const source = new URL("protocol/typescript/client.ts", repository);

async function bundled() {
  const esbuild = createRequire(new URL("web_client/package.json", repository))("esbuild");
  const folder = mkdtempSync(join(tmpdir(), "heliograph-typescript-"));
  try {
    const outfile = join(folder, "client.mjs");
    const entryPoints = [fileURLToPath(source)];
    await esbuild.build({ entryPoints, outfile, bundle: true, format: "esm", target: "node18" });
    return await import(pathToFileURL(outfile).href);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const { HeliographClient } = await (process.features.typescript
  ? import(source.href)
  : bundled());

/** Runs `use` with a client, which is closed afterwards. */
async function connected(options, use) {
  const client = await HeliographClient.connect(url, { token, webSocket, ...options });
  try {
    return await use(client);
  } finally {
    client.close();
  }
}

/** A promise and the function that fulfils it. */
function deferred() {
  let resolve;
  const promise = new Promise((fulfil) => (resolve = fulfil));
  return { promise, resolve };
}

/** A call that takes minutes. */
async function slowCall(client, timeoutMs) {
  await client.request("settings.patch", { patch: { accumulation: { max_samples: 65536 } } });
  return client.request("frame.capture", { samples: 65536 }, timeoutMs);
}

test("only clients with the token are accepted", async () => {
  await connected({}, (client) => assert.equal(client.hello.protocol, "heliograph.v1"));
  for (const wrong of [undefined, `${token}-and-more`]) {
    await assert.rejects(connected({ token: wrong }, () => {}), /accepts this client/);
  }
});

test("a client can join another session", async () => {
  await connected({}, async (client) => {
    await client.request("session.create", { name: "second", width: 48, height: 32 });
    await connected({ session: "second" }, async (other) => {
      assert.equal(other.hello.session, "second");
      assert.equal((await other.request("session.info")).width, 48);
      await other.request("session.close", { session: "second" });
    });
  });
  await assert.rejects(
    connected({ session: "nowhere" }, () => {}),
    ({ code, data }) => code === -32004 && data.path === "session",
  );
});

test("calls have the given timeout", { timeout: 20_000 }, async () => {
  const late = ({ code, message }) => code === 0 && message.includes("0.2 s");
  await connected({ timeoutMs: 200 }, async (client) => {
    await assert.rejects(slowCall(client), late);
    assert.ok(await client.request("scene.list", {}, 20_000));
  });
  await connected({}, (client) => assert.rejects(slowCall(client, 200), late));
});

test("frames continue after an error in their callback", { timeout: 60_000 }, async () => {
  const enough = deferred();
  const errors = [];
  let frames = 0;
  await connected({}, async (mover) => {
    const frame = () => {
      mover.notify("camera.orbit", { yaw: 3 });
      frames += 1;
      if (frames === 20) enough.resolve();
      const error = new Error(`frame ${frames}`);
      if (frames % 2) throw error;
      return Promise.reject(error);
    };
    await connected({ frame, error: (error) => errors.push(error.message) }, async (client) => {
      await enough.promise;
      assert.ok(await client.request("scene.list"));
    });
  });
  assert.deepEqual(errors.slice(0, 3), ["frame 1", "frame 2", "frame 3"]);
});

test("without a frame callback the stream is paused", async () => {
  await connected({}, async (client) => {
    assert.equal((await client.configureStream({})).paused, true);
  });
  await connected({ frame: () => {} }, async (client) => {
    assert.equal((await client.configureStream({})).paused, false);
  });
});

test("an error in a notification callback does not end the connection", { timeout: 20_000 }, async () => {
  const reported = deferred();
  const notification = (method) => {
    throw new Error(method);
  };
  await connected({ notification, error: reported.resolve }, async (client) => {
    await connected({}, (other) => other.request("camera.orbit", { yaw: 3 }));
    assert.match((await reported.promise).message, /changed/);
    assert.ok(await client.request("scene.list"));
  });
});

test("an error without an id fails all pending calls", { timeout: 20_000 }, async () => {
  await connected({}, async (client) => {
    const rejected = assert.rejects(slowCall(client), ({ code }) => code === -32700);
    await client.request("scene.list");
    await client.request("scene.list");
    client.socket.send("not JSON");
    await rejected;
    assert.ok(await client.request("scene.list"));
  });
});
