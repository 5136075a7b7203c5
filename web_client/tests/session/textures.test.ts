import assert from "node:assert/strict";
import test from "node:test";
import { RpcError } from "heliograph/rpc.ts";
import { Signal } from "../../src/common/signal.ts";
import { optionsOf } from "../../src/panel/scene/texture_rows.ts";
import { UndoHistory } from "../../src/session/history/undo_history.ts";
import { Textures, choiceOf, describeFileTexture } from "../../src/session/edits/textures.ts";
import type { Texture } from "../../src/session/edits/textures.ts";

const planks: Texture = {
  material: "floor",
  slot: "base_color",
  file_image: "planks",
  width: 64,
  height: 32,
  removed: false,
};

/** A server with one texture, that answers as it is told. */
function serve(refused: Error | null = null) {
  let refusal = refused;
  const calls: [string, unknown][] = [];
  let texture = planks;
  const request = (method: string, params: Record<string, unknown> = {}): Promise<unknown> => {
    if (method !== "textures.set") {
      return Promise.resolve({ slots: ["base_color"], textures: [texture], rev: 1, images: [] });
    }
    calls.push([method, params]);
    if (refusal) return Promise.reject(refusal);
    const { image, removed } = params as { image?: string | null; removed?: boolean };
    texture = { ...planks, removed: removed ?? false, ...(image ? { image } : {}) };
    return Promise.resolve({ texture, rev: 2 });
  };
  const loading: string[] = [];
  const errors: unknown[] = [];
  const history = new UndoHistory();
  const textures = new Textures({
    rpc: { request } as never,
    scene: new Signal({ name: "room" }) as never,
    capabilities: { has: () => true, methods: new Signal(new Set<string>()) } as never,
    history,
    loading: {
      start: ({ kind }: { kind: string }) => loading.push(kind),
      takesEffect: (rev: number) => loading.push(`from ${rev}`),
      endTexture: () => loading.push("end"),
    } as never,
    report: (error) => errors.push(error),
    changed: () => loading.push("materials"),
  });
  const refuse = (error: Error | null): void => void (refusal = error);
  return { textures, calls, loading, errors, history, refuse };
}

const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

test("a texture is replaced, and undo brings the file's back", async () => {
  const { textures, calls, loading, history } = serve();
  await settled();
  assert.equal(await textures.choose("floor", "base_color", { image: "bricks" }), true);
  assert.deepEqual(loading, ["texture", "from 2", "materials"]);
  assert.equal(textures.find("floor", "base_color")?.image, "bricks");
  assert.equal(history.next.value.undo, "base color texture of floor");
  history.undo();
  await settled();
  assert.deepEqual(calls.at(-1), [
    "textures.set",
    { material: "floor", slot: "base_color", image: null },
  ]);
  assert.equal(textures.find("floor", "base_color")?.image, undefined);
});

test("a change that the server refuses is told and no step of the history", async () => {
  const { textures, loading, errors, history } = serve(new Error("refused"));
  await settled();
  assert.equal(await textures.choose("floor", "base_color", { removed: true }), false);
  assert.equal(errors.length, 1);
  assert.equal(loading.at(-1), "end");
  assert.equal(history.next.value.undo, null);
});

test("undo that the server refuses is told as an error, and can be tried again", async () => {
  const { textures, errors, history, refuse } = serve();
  await settled();
  await textures.choose("floor", "base_color", { image: "moss" });
  await textures.choose("floor", "base_color", { image: "bricks" });
  const label = "base color texture of floor";
  const gone = new RpcError(-32004, 'image: "moss" is not one of the images', { path: "image" });
  refuse(gone);
  assert.equal(await history.undo(), null);
  assert.deepEqual(errors, [gone]);
  assert.deepEqual(history.next.value, { undo: label, redo: null });
  assert.equal(textures.find("floor", "base_color")?.image, "bricks");
  refuse(null);
  assert.equal(await history.undo(), label);
  assert.equal(textures.find("floor", "base_color")?.image, "moss");
  refuse(gone);
  assert.equal(await history.redo(), null);
  assert.deepEqual(history.next.value, { undo: label, redo: label });
});

test("what a later load has replaced is no error, a scene that is another by now is", async () => {
  const { textures, errors, refuse } = serve();
  await settled();
  for (const path of ["image", "scene"]) {
    refuse(new RpcError(-32009, path, { path }));
    assert.equal(await textures.choose("floor", "base_color", { removed: true }), false);
  }
  assert.deepEqual(
    errors.map((error) => (error as Error).message),
    ["scene"],
  );
});

test("what a slot has is told in words and can be chosen again", () => {
  assert.equal(describeFileTexture(planks), "planks, 64 × 32");
  assert.equal(describeFileTexture({ ...planks, file_image: "" }), "64 × 32");
  assert.equal(describeFileTexture({ ...planks, width: 0 }), "planks, cannot be read");
  assert.equal(describeFileTexture(undefined), "none");
  assert.deepEqual(choiceOf(undefined), { image: null });
  assert.deepEqual(choiceOf({ ...planks, image: "bricks" }), { image: "bricks" });
  assert.deepEqual(choiceOf({ ...planks, removed: true }), { removed: true });
});

test("an image that the server has no longer stays among the choices", () => {
  const images = new Signal([{ name: "bricks", bytes: 1, uploaded: true }]);
  const find = (): Texture => ({ ...planks, image: "gone" });
  const labels = optionsOf({ find, images }, "floor", "base_color").map(({ label }) => label);
  assert.deepEqual(labels, ["As in the file: planks, 64 × 32", "None", "bricks", "gone"]);
});
