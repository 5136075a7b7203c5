import assert from "node:assert/strict";
import test, { afterEach } from "node:test";
import { deleteUpload } from "../../src/common/uploads.ts";
import { receiveNotification } from "../../src/session/notifications.ts";

const realFetch = globalThis.fetch;
afterEach(() => {
  globalThis.fetch = realFetch;
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
  const viewer = {
    connection: { address: { url: (path: string) => new URL(path, "http://here/?session=a") } },
    shown: { readList: reads("scenes") },
    parts: { read: reads("environments") },
    textures: { read: reads("images") },
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

test("a change of the uploads by anyone reads the list that it is about", () => {
  const { viewer, read } = page(204);
  const notify = (kind: string) =>
    receiveNotification(viewer as never, "uploads.changed", { kind, name: "box", deleted: true });
  for (const kind of ["image", "scene", "environment"]) notify(kind);
  assert.deepEqual(read, ["images", "scenes", "environments"]);
});
