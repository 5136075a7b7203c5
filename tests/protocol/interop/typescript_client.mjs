// The TypeScript library by itself against a real server: as it stands where Node takes TypeScript,
// bundled where it does not; with Node's own WebSocket where there is one, else that of ws.

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

/** Runs `use` with a client, which is closed then. */
async function connected(options, use) {
  const client = await HeliographClient.connect(url, { token, webSocket, ...options });
  try {
    return await use(client);
  } finally {
    client.close();
  }
}

/** A promise and the function that fulfils it. */
function moment() {
  let come;
  const comes = new Promise((resolve) => (come = resolve));
  return { come, comes };
}

/** A call that the server answers only after minutes. */
async function slowCall(client, timeoutMs) {
  await client.request("settings.patch", { patch: { accumulation: { max_samples: 65536 } } });
  return client.request("frame.capture", { samples: 65536 }, timeoutMs);
}

test("only who shows the token is let in", async () => {
  await connected({}, (client) => assert.equal(client.hello.protocol, "heliograph.v1"));
  for (const wrong of [undefined, `${token}-and-more`]) {
    await assert.rejects(connected({ token: wrong }, () => {}), /lets this client in/);
  }
});

test("a client may be in another session", async () => {
  await connected({}, async (client) => {
    await client.request("session.create", { name: "aside", width: 48, height: 32 });
    await connected({ session: "aside" }, async (other) => {
      assert.equal(other.hello.session, "aside");
      assert.equal((await other.request("session.info")).width, 48);
      await other.request("session.close", { session: "aside" });
    });
  });
  await assert.rejects(
    connected({ session: "nowhere" }, () => {}),
    ({ code, data }) => code === -32004 && data.path === "session",
  );
});

test("calls wait as long as they are told to", { timeout: 20_000 }, async () => {
  const late = ({ code, message }) => code === 0 && message.includes("0.2 s");
  await connected({ timeoutMs: 200 }, async (client) => {
    await assert.rejects(slowCall(client), late);
    assert.ok(await client.request("scene.list", {}, 20_000));
  });
  await connected({}, (client) => assert.rejects(slowCall(client, 200), late));
});

test("pictures go on coming where their function fails", { timeout: 60_000 }, async () => {
  const enough = moment();
  const errors = [];
  let pictures = 0;
  await connected({}, async (mover) => {
    const frame = () => {
      mover.notify("camera.orbit", { yaw: 3 });
      pictures += 1;
      if (pictures === 20) enough.come();
      const error = new Error(`picture ${pictures}`);
      if (pictures % 2) throw error;
      return Promise.reject(error);
    };
    await connected({ frame, error: (error) => errors.push(error.message) }, async (client) => {
      await enough.comes;
      assert.ok(await client.request("scene.list"));
    });
  });
  assert.deepEqual(errors.slice(0, 3), ["picture 1", "picture 2", "picture 3"]);
});

test("without a function for them no pictures come", async () => {
  await connected({}, async (client) => {
    assert.equal((await client.configureStream({})).paused, true);
  });
  await connected({ frame: () => {} }, async (client) => {
    assert.equal((await client.configureStream({})).paused, false);
  });
});

test("a listener that fails ends nothing", { timeout: 20_000 }, async () => {
  const told = moment();
  const notification = (method) => {
    throw new Error(method);
  };
  await connected({ notification, error: told.come }, async (client) => {
    await connected({}, (other) => other.request("camera.orbit", { yaw: 3 }));
    assert.match((await told.comes).message, /changed/);
    assert.ok(await client.request("scene.list"));
  });
});

test("an error of no known call ends all that wait", { timeout: 20_000 }, async () => {
  await connected({}, async (client) => {
    const refused = assert.rejects(slowCall(client), ({ code }) => code === -32700);
    await client.request("scene.list");
    await client.request("scene.list");
    client.socket.send("no JSON");
    await refused;
    assert.ok(await client.request("scene.list"));
  });
});
