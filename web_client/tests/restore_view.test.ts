import assert from "node:assert/strict";
import test from "node:test";
import type { JsonObject } from "heliograph/json.ts";
import { RpcPeer } from "heliograph/rpc.ts";
import { describeControls } from "heliograph/settings_schema.ts";
import { restoreView } from "../src/session/restore_view.ts";
import { type ViewState, changesOf, patchTowards, withoutPath } from "../src/session/view_state.ts";

const schema = describeControls({
  properties: {
    exposure: {
      properties: { ev: { type: "number", default: 0 }, old: { type: "number", default: 1 } },
    },
    taa: { properties: { enabled: { type: "boolean", default: true } } },
  },
});
const defaults: JsonObject = { exposure: { ev: 0, old: 1 }, taa: { enabled: true } };
const camera = {
  eye: [1, 2, 3],
  target: [0, 0, 0],
  up: [0, 1, 0],
  vertical_fov: 40,
  name: null,
} as const;
const state = {
  scene: "b.glb",
  settings: { exposure: { ev: 2 } },
  clip: { clip: "walk", seconds: 1.5, rate: 2, playing: false },
  camera,
} as unknown as ViewState;

/** Slots of materials of the server's scene. */
const textures = [
  { material: "floor", slot: "base_color", file_image: "planks", removed: false },
  { material: "floor", slot: "normal", image: "bumps", removed: false },
  { material: "wall", slot: "base_color", image: "red", removed: false },
];

type Answer = { result?: unknown; error?: { code: number; message: string; data?: object } };

/** A server that has loaded a.glb after two requests and records all calls. */
function startingServer(rejections: (method: string, params: JsonObject) => Answer | null) {
  const calls: string[] = [];
  const skipped: string[] = [];
  let scene: string | null = null;
  let polls = 0;
  const answerTo = (method: string, params: JsonObject): Answer => {
    const rejected = rejections(method, params);
    if (rejected) return rejected;
    if (method === "scene.info") {
      polls += 1;
      if (polls === 3) scene = "a.glb";
      return scene
        ? { result: { name: scene, cameras: [] } }
        : { error: { code: -32050, message: "no scene is loaded" } };
    }
    calls.push(`${method} ${JSON.stringify(params)}`);
    if (method === "scene.load") scene = params.name as string;
    if (method === "settings.get") return { result: { settings: defaults } };
    if (method === "lights.list") {
      const sun = { name: "sun", intensity: 3, enabled: false, changed: ["enabled"] };
      return { result: { lights: [sun, { name: "bulb", intensity: 1, changed: [] }] } };
    }
    if (method === "textures.list") return { result: { textures } };
    if (method === "environment.list") return { result: { environments: [], current: "dusk" } };
    if (method === "animation.list") {
      return { result: { clips: [{ name: "walk", duration: 3 }], clip: null, playing: false } };
    }
    return { result: {} };
  };
  const rpc: RpcPeer = new RpcPeer(
    (text) => {
      const { id, method, params } = JSON.parse(text);
      setTimeout(() => {
        rpc.receive(JSON.stringify({ jsonrpc: "2.0", id, ...answerTo(method, params) }));
      }, 0);
    },
    () => {},
  );
  rpc.open();
  const host = {
    rpc,
    schema: () => schema,
    supports: () => true,
    isCurrent: () => true,
    ownsSession: () => false,
    reportSkipped: (sentence: string) => void skipped.push(sentence),
    reportFile: ({ sentence }: { sentence: string }) => void skipped.push(sentence),
  };
  return { host, calls, skipped };
}

test("a new server gets the previous state after its initial scene is loaded", async () => {
  const { host, calls, skipped } = startingServer(() => null);
  assert.equal(await restoreView(host, state), true);
  assert.deepEqual(calls, [
    'scene.load {"name":"b.glb"}',
    "settings.get {}",
    'settings.patch {"patch":{"exposure":{"ev":2}}}',
    "animation.list {}",
    'animation.play {"clip":"walk","rate":2}',
    'animation.seek {"seconds":1.5}',
    "animation.pause {}",
    'camera.set {"eye":[1,2,3],"target":[0,0,0],"up":[0,1,0],"vertical_fov":40}',
  ]);
  assert.deepEqual(skipped, []);
});

test("an own session gets its scene without waiting for an initial one", async () => {
  const { host, calls, skipped } = startingServer((method) =>
    method === "scene.info" && calls.length === 0
      ? { error: { code: -32050, message: "no scene is loaded" } }
      : null,
  );
  assert.equal(await restoreView({ ...host, ownsSession: () => true }, state), true);
  assert.equal(calls[0], 'scene.load {"name":"b.glb"}');
  assert.deepEqual(skipped, []);
});

test("an own session whose scene cannot be loaded gets the settings and nothing else", async () => {
  const { host, calls, skipped } = startingServer((method) => {
    if (method === "scene.info") return { error: { code: -32050, message: "no scene is loaded" } };
    if (method !== "scene.load") return null;
    const data = { path: "name", reason: "is not in the catalogue; did you mean a?" };
    return { error: { code: -32004, message: "name: is not in the catalogue", data } };
  });
  assert.equal(await restoreView({ ...host, ownsSession: () => true }, state), true);
  assert.deepEqual(skipped, ["There is no scene 'b.glb'."]);
  assert.deepEqual(calls, ["settings.get {}", 'settings.patch {"patch":{"exposure":{"ev":2}}}']);
});

test("a camera that fails with a transient error is sent again", async () => {
  let rejected = 0;
  const { host, calls } = startingServer((method) => {
    if (method !== "camera.set" || rejected++ >= 2) return null;
    return { error: { code: -32050, message: "not yet" } };
  });
  assert.equal(await restoreView(host, { camera: state.camera }), true);
  assert.equal(rejected, 3);
  assert.match(calls.at(-1) ?? "", /^camera\.set/);
});

test("settings that the server rejects are left out, the others are restored", async () => {
  const { host, calls, skipped } = startingServer((method, params) => {
    const patch = params.patch as { exposure?: { old?: number } } | undefined;
    if (method !== "settings.patch" || patch?.exposure?.old === undefined) return null;
    const data = { path: "exposure.old", reason: "unknown" };
    return { error: { code: -32602, message: "exposure.old", data } };
  });
  await restoreView(host, { settings: { exposure: { ev: 2, old: 7 } } });
  assert.ok(calls.includes('settings.patch {"patch":{"exposure":{"ev":2}}}'));
  assert.match(skipped.join(), /exposure\.old/);
});

test("textures are restored together, and others are the file's again", async () => {
  const { host, calls, skipped } = startingServer((method, params) =>
    method === "textures.set" && params.image === "gone"
      ? { error: { code: -32004, message: "no such image", data: { path: "image" } } }
      : null,
  );
  const wanted = [
    { material: "floor", slot: "base_color", image: "moss" },
    { material: "wall", slot: "base_color", image: "red" },
    { material: "wall", slot: "normal", image: null },
    { material: "door", slot: "normal", image: "gone" },
  ];
  assert.equal(await restoreView(host, { textures: wanted }), true);
  assert.deepEqual(calls.filter((call) => call.startsWith("textures.")), [
    "textures.list {}",
    'textures.set {"material":"floor","slot":"base_color","image":"moss"}',
    'textures.set {"material":"wall","slot":"normal","removed":true}',
    'textures.set {"material":"floor","slot":"normal","image":null}',
  ]);
  assert.deepEqual(skipped, ["The server rejects the previous normal texture of door"]);
});

test("lights are restored: differences are sent, other edits are reset", async () => {
  const { host, calls, skipped } = startingServer((method, params) =>
    method === "lights.patch" && params.light === "bulb"
      ? { error: { code: -32004, message: "no such light" } }
      : null,
  );
  const lights = { sun: { intensity: 3.5 }, bulb: { intensity: 2 }, gone: { intensity: 1 } };
  assert.equal(await restoreView(host, { lights, environment: null }), true);
  assert.deepEqual(calls, [
    "environment.list {}",
    'environment.set {"name":null}',
    "lights.list {}",
    'lights.patch {"light":"sun","patch":{"enabled":null,"intensity":3.5}}',
  ]);
  assert.deepEqual(skipped, ["The server rejects the previous state of bulb"]);
});

test("a state that is not current any more stops", async () => {
  const { host, calls } = startingServer(() => null);
  assert.equal(await restoreView({ ...host, isCurrent: () => calls.length < 2 }, state), false);
  assert.ok(!calls.some((call) => call.startsWith("camera.set")));
});

test("changes and patches contain differences only", () => {
  const tree: JsonObject = { exposure: { ev: 2, old: 1 }, taa: { enabled: true } };
  assert.deepEqual(changesOf(schema, tree), { exposure: { ev: 2 } });
  assert.equal(patchTowards(schema, tree, { exposure: { ev: 2 } }), null);
  assert.deepEqual(patchTowards(schema, tree, { taa: { enabled: false } }), {
    exposure: { ev: 0 },
    taa: { enabled: false },
  });
  assert.deepEqual(withoutPath({ a: { b: 1 }, c: 2 }, "a.b"), { c: 2 });
});
