import assert from "node:assert/strict";
import test from "node:test";
import type { JsonObject, JsonValue } from "heliograph/json.ts";
import { RpcPeer } from "heliograph/rpc.ts";
import { refinementOf, refinementText, shownSamples } from "../src/session/refinement.ts";
import { UndoHistory } from "../src/session/history/undo_history.ts";
import { SettingsStore } from "../src/session/settings_store.ts";

const schema: JsonObject = {
  properties: {
    exposure: {
      "x-order": 0,
      properties: {
        ev: { type: "number", minimum: -4, maximum: 4, default: 0 },
        auto: { type: "boolean", default: false },
      },
    },
  },
};

interface Request {
  id: number;
  method: string;
  params: { patch?: JsonObject };
}

/** A channel to a server that the test plays: it reads requests and answers on demand. */
async function connected() {
  const sent: Request[] = [];
  const errors: unknown[] = [];
  const rpc: RpcPeer = new RpcPeer(
    (text) => sent.push(JSON.parse(text) as Request),
    () => {},
  );
  rpc.open();
  const answer = async (body: object): Promise<Request> => {
    const request = sent.shift();
    assert.ok(request, "nothing was sent");
    rpc.receive(JSON.stringify({ jsonrpc: "2.0", id: request.id, ...body }));
    await new Promise((resolve) => setTimeout(resolve, 0));
    return request;
  };
  const store = new SettingsStore(rpc, new UndoHistory(), (error) => errors.push(error));
  const loaded = store.load();
  await answer({ result: schema });
  await answer({ result: { rev: 1, settings: { exposure: { ev: 0, auto: false } } } });
  await loaded;
  return { store, sent, errors, answer };
}

test("a change shows at once and is sent as the smallest patch", async () => {
  const { store, answer } = await connected();
  store.change("exposure.ev", 2);
  assert.equal(store.value("exposure.ev"), 2);
  const request = await answer({ result: { rev: 2, applied: { exposure: { ev: 2 } } } });
  assert.equal(request.method, "settings.patch");
  assert.deepEqual(request.params.patch, { exposure: { ev: 2 } });
});

test("changes during a request are merged and do not flicker", async () => {
  const { store, sent, answer } = await connected();
  store.change("exposure.ev", 1);
  store.change("exposure.ev", 2);
  store.change("exposure.ev", 3);
  store.change("exposure.auto", true);
  assert.equal(sent.length, 1);
  await answer({ result: { rev: 2, applied: { exposure: { ev: 1 } } } });
  assert.equal(store.value("exposure.ev"), 3);
  const second = await answer({ result: { rev: 3, applied: { exposure: { ev: 3, auto: true } } } });
  assert.deepEqual(second.params.patch, { exposure: { ev: 3, auto: true } });
  assert.equal(sent.length, 0);
});

test("a rejected change is reported and the server's value returns", async () => {
  const { store, errors, answer } = await connected();
  store.change("exposure.ev", 4);
  await answer({ error: { code: -32602, message: "exposure.ev is locked" } });
  assert.equal(errors.length, 1);
  await answer({ result: { rev: 1, settings: { exposure: { ev: 0, auto: false } } } });
  assert.equal(store.value("exposure.ev"), 0);
});

test("a reset sends null and shows the default", async () => {
  const { store, answer } = await connected();
  store.receive({ patch: { exposure: { ev: 3 } }, rev: 2 });
  assert.equal(store.value("exposure.ev"), 3);
  store.reset("exposure.ev");
  assert.equal(store.value("exposure.ev"), 0);
  const request = await answer({ result: { rev: 2, applied: { exposure: { ev: 0 } } } });
  assert.deepEqual(request.params.patch, { exposure: { ev: null } });
});

test("resetting a group touches only what was changed", async () => {
  const { store, answer } = await connected();
  store.receive({ patch: { exposure: { auto: true } }, rev: 2 });
  const group = store.schema.value.groups[0];
  assert.ok(group);
  store.resetGroup(group);
  const request = await answer({ result: { rev: 2, applied: { exposure: { auto: false } } } });
  assert.deepEqual(request.params.patch, { exposure: { auto: null } });
});

/** What a view that is refined reads of the settings. */
function refined(use: string, indirect = true): { value(path: string): JsonValue | undefined } {
  const values: JsonObject = {
    "accumulation.max_samples": 64,
    "reference.samples": 512,
    "reference.use": use,
    "indirect.enabled": indirect,
  };
  return { value: (path) => values[path] };
}

const text = (samples: number, use: string, indirect?: boolean): string =>
  refinementText(refinementOf(samples, refined(use, indirect)));

test("samples of the reference are counted from its first on", () => {
  assert.equal(text(24, "automatic"), "24 of 64 samples");
  assert.equal(text(64, "automatic"), "0 of 512 path traced samples");
  assert.equal(text(76, "automatic"), "12 of 512 path traced samples");
  assert.equal(text(76, "when_static", false), "12 of 512 path traced samples");
});

test("without the reference all are the hybrid's", () => {
  assert.equal(text(64, "off"), "64 of 64 samples");
  assert.equal(text(64, "automatic", false), "64 of 64 samples");
  assert.equal(text(76, "off"), "76 of 76 samples"); // the limit was lowered
});

test("an image has the samples that it shows", () => {
  assert.equal(shownSamples(1, refined("automatic")), "1 sample");
  assert.equal(shownSamples(64, refined("automatic")), "64 samples");
  assert.equal(shownSamples(65, refined("automatic")), "1 path traced sample");
});
