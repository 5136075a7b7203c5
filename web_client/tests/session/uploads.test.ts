import assert from "node:assert/strict";
import test, { afterEach, mock } from "node:test";
import { Signal } from "../../src/common/signal.ts";
import { UploadLists, deleteUpload } from "../../src/common/uploads.ts";
import { ScenePreviews } from "../../src/previews/scene_previews.ts";
import { UndoHistory } from "../../src/session/history/undo_history.ts";
import { receiveNotification } from "../../src/session/notifications.ts";
import { SceneParts } from "../../src/session/scene_parts.ts";

const realFetch = globalThis.fetch;
afterEach(() => {
  globalThis.fetch = realFetch;
  mock.timers.reset();
});

/** A page whose server answers requests with this status, or not at all. */
function page(status: number | null, text = "") {
  const requests: string[] = [];
  const read: string[] = [];
  const errors: string[] = [];
  globalThis.fetch = (url, options) => {
    requests.push(`${options?.method} ${String(url)}`);
    if (status === null) return Promise.reject(new TypeError("fetch failed"));
    return Promise.resolve(new Response(status === 204 ? null : text, { status }));
  };
  const reads = (list: string) => () => {
    read.push(list);
    return Promise.resolve();
  };
  const uploads = new UploadLists({
    shown: { readList: reads("scenes") },
    parts: { readEnvironments: reads("environments") },
    textures: { readImages: reads("images") },
  });
  const viewer = {
    connection: { address: { url: (path: string) => new URL(path, "http://here/?session=a") } },
    uploads,
    report: (error: unknown) => errors.push((error as Error).message),
  };
  return { viewer, requests, read, errors };
}

test("an upload is deleted at the address where it was sent, and its list is read again", async () => {
  for (const [kind, list] of [
    ["scene", "scenes"],
    ["environment", "environments"],
    ["image", "images"],
  ] as const) {
    const { viewer, requests, read, errors } = page(204);
    assert.equal(await deleteUpload(viewer, kind, "box"), true);
    assert.deepEqual(requests, [`DELETE http://here/api/v1/${kind}s/box`]);
    assert.deepEqual(read, [list]);
    assert.deepEqual(errors, []);
  }
});

test("what another viewer has deleted before is gone, too", async () => {
  const { viewer, read, errors } = page(404, "name: is not the name of an upload\n");
  assert.equal(await deleteUpload(viewer, "scene", "box"), true);
  assert.deepEqual(read, ["scenes"]);
  assert.deepEqual(errors, []);
});

test("a refusal is told with its reason, and a lost connection as such", async () => {
  const refused = page(403, "This token is read-only and cannot delete uploads.\n");
  assert.equal(await deleteUpload(refused.viewer, "image", "box"), false);
  assert.deepEqual(refused.read, []);
  assert.deepEqual(refused.errors, [
    "box was not deleted: This token is read-only and cannot delete uploads.",
  ]);
  const lost = page(null);
  assert.equal(await deleteUpload(lost.viewer, "scene", "box"), false);
  assert.deepEqual(lost.errors, ["box was not deleted: no connection to the server"]);
});

const settled = async (): Promise<void> => {
  for (let i = 0; i < 20; i += 1) await Promise.resolve();
};
type Kind = "scene" | "environment" | "image";

function notify(viewer: object, kind: Kind, deleted = true, name = "box"): void {
  receiveNotification(viewer as never, "uploads.changed", { kind, name, deleted });
}

test("changes of the uploads by anyone read the list that they are about, once", () => {
  mock.timers.enable(["setTimeout"]);
  const { viewer, read } = page(204);
  for (const kind of ["image", "scene", "environment"] as const) {
    viewer.uploads.keep(kind, () => true);
    for (let count = 0; count < 5; ++count) notify(viewer, kind);
  }
  assert.deepEqual(read, []);
  mock.timers.tick(200);
  notify(viewer, "scene");
  mock.timers.tick(100);
  assert.deepEqual(read, ["images", "scenes", "environments"]);
  notify(viewer, "scene");
  mock.timers.tick(299);
  assert.equal(read.length, 3);
  mock.timers.tick(1);
  assert.deepEqual(read.slice(3), ["scenes"], "once more after the last change");
  mock.timers.tick(1000);
  assert.equal(read.length, 4);
});

test("a list that is not shown is read when it is shown, if it has changed", async () => {
  mock.timers.enable(["setTimeout"]);
  const { viewer, read } = page(204);
  let shown = false;
  viewer.uploads.keep("image", () => shown);
  await viewer.uploads.refresh("image");
  notify(viewer, "image");
  mock.timers.tick(1000);
  assert.deepEqual(read, []);
  shown = true;
  await viewer.uploads.refresh("image");
  await viewer.uploads.refresh("image");
  assert.deepEqual(read, ["images"]);
});

test("other environments are read alone, and stay without an answer", async () => {
  const requests: string[] = [];
  let answers = true;
  const environments = [{ name: "sky", bytes: 1, uploaded: true }];
  const request = (method: string): Promise<unknown> => {
    requests.push(method);
    if (!answers) return Promise.reject(new Error("lost"));
    return Promise.resolve({ lights: [{ name: "sun" }], materials: [], environments });
  };
  const parts = new SceneParts({
    rpc: { request } as never,
    scene: new Signal({ name: "room" }) as never,
    capabilities: { methods: new Signal(new Set<string>()), has: () => true } as never,
    history: new UndoHistory(),
    loading: {} as never,
    shows: () => {},
    report: (error) => assert.fail(String(error)),
  });
  await settled();
  requests.length = 0;
  environments.push({ name: "dusk", bytes: 1, uploaded: true });
  await parts.readEnvironments();
  answers = false;
  await parts.readEnvironments();
  assert.deepEqual(requests, ["environment.list", "environment.list"]);
  assert.equal(parts.environment.value?.environments.length, 2);
  assert.equal(parts.lights.value.length, 1);
});

test("a scene that was uploaded again has its thumbnail fetched again", async () => {
  mock.timers.enable(["setTimeout"]);
  Object.assign(globalThis, { document: { hidden: false } });
  const { viewer } = page(404);
  const fetched: string[] = [];
  let answer = (): void => {};
  globalThis.fetch = (url, options) => {
    fetched.push(`${options?.cache} ${new URL(String(url)).pathname}`);
    return new Promise((resolve) => (answer = () => resolve(new Response("", { status: 404 }))));
  };
  const answered = async (): Promise<void> => {
    answer();
    await settled();
  };
  const scenes = new Signal({ scenes: [{ name: "box" }], current: null });
  const previews = new ScenePreviews({ ...viewer, scenes, hello: {} } as never);
  const address = "no-cache /api/v1/scenes/box/thumbnail.jpg";
  notify(viewer, "scene", false);
  assert.deepEqual(fetched, [], "not while no gallery is open");
  previews.start();
  await answered();
  previews.start();
  assert.deepEqual(fetched, [address]);
  notify(viewer, "scene", true);
  assert.equal(fetched.length, 1, "what is deleted has none");
  notify(viewer, "scene", false);
  assert.deepEqual(fetched, [address, address]);
  notify(viewer, "scene", false);
  await answered();
  mock.timers.tick(1500);
  await settled();
  assert.equal(fetched.length, 3, "the answer was that of the file before");
  previews.stop();
  await answered();
});
