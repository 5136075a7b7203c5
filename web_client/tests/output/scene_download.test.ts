import assert from "node:assert/strict";
import test, { afterEach } from "node:test";
import { downloadScene } from "../../src/output/scene_download.ts";

const url = new URL("http://127.0.0.1/api/v1/sessions/main/scene.glb");
const { fetch } = globalThis;
afterEach(() => {
  globalThis.fetch = fetch;
});

function answerWith(response: Response): void {
  globalThis.fetch = () => Promise.resolve(response);
}

const { signal } = new AbortController();

test("the file of a scene comes with its progress and with what it lacks", async () => {
  const headers = {
    "content-length": "5",
    "x-heliograph-warnings": JSON.stringify(["section planes: glTF has none"]),
  };
  answerWith(new Response(new Uint8Array([1, 2, 3, 4, 5]), { headers }));
  const steps: [number, number][] = [];
  const { file, warnings } = await downloadScene(url, signal, (...step) => steps.push(step));
  assert.deepEqual([...new Uint8Array(await file.arrayBuffer())], [1, 2, 3, 4, 5]);
  assert.deepEqual(steps.at(-1), [5, 5]);
  assert.deepEqual(warnings, ["section planes: glTF has none"]);
});

test("a file without warnings lacks nothing", async () => {
  answerWith(new Response(new Uint8Array([1])));
  assert.deepEqual((await downloadScene(url, signal, () => {})).warnings, []);
});

test("a refused export is an error with the server's reason", async () => {
  answerWith(new Response("no scene is loaded\n", { status: 503 }));
  await assert.rejects(
    downloadScene(url, signal, () => {}),
    new Error("no scene is loaded"),
  );
});
