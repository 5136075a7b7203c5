import assert from "node:assert/strict";
import test from "node:test";
import { SceneLoading } from "../../src/session/scene_loading.ts";

type Host = ConstructorParameters<typeof SceneLoading>[0];

function seen(loading: SceneLoading): boolean | undefined {
  return loading.current.value?.firstView;
}

function progress(stage: string, first_view: boolean) {
  return { name: "hall", stage, fraction: 0.4, first_view, by: "viewer-1" };
}

test("a scene without its textures is seen with its first frame, not with the message", () => {
  const loading = new SceneLoading({} as Host);
  loading.frameDrawn(7);
  loading.progressed(progress("meshes", false));
  assert.equal(seen(loading), false);
  loading.progressed(progress("textures", true));
  assert.equal(seen(loading), false);
  loading.frameDrawn(7);
  assert.equal(seen(loading), false);
  loading.frameDrawn(8);
  assert.equal(seen(loading), true);
  loading.progressed(progress("textures", true));
  assert.equal(seen(loading), true);
});

test("what was seen of a load that ended is not taken for the next one", () => {
  const loading = new SceneLoading({} as Host);
  loading.progressed(progress("textures", true));
  loading.frameDrawn(3);
  assert.equal(seen(loading), true);
  loading.progressed(progress("failed", false));
  assert.equal(loading.current.value, null);
  loading.progressed(progress("meshes", false));
  assert.equal(seen(loading), false);
});
