import assert from "node:assert/strict";
import test from "node:test";
import { UndoHistory } from "../../src/session/history/undo_history.ts";
import { SceneLoading } from "../../src/session/scene_loading.ts";

type Host = ConstructorParameters<typeof SceneLoading>[0];

function hostWith(history: UndoHistory, more: Partial<Host> = {}): Host {
  return { history, isRestoring: () => false, ...more } as Host;
}

function seen(loading: SceneLoading): boolean | undefined {
  return loading.current.value?.firstView;
}

function progress(stage: string, first_view: boolean) {
  return { name: "hall", stage, fraction: 0.4, first_view, by: "viewer-1" };
}

test("a scene without its textures is seen with its first frame, not with the message", () => {
  const loading = new SceneLoading(hostWith(new UndoHistory()));
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
  const loading = new SceneLoading(hostWith(new UndoHistory()));
  loading.progressed(progress("textures", true));
  loading.frameDrawn(3);
  assert.equal(seen(loading), true);
  loading.progressed(progress("failed", false));
  assert.equal(loading.current.value, null);
  loading.progressed(progress("meshes", false));
  assert.equal(seen(loading), false);
});

/** A page that has moved the camera in "hall" and loads "garden", as far as its first view. */
function entering() {
  let now = 0;
  const undone: string[] = [];
  const history = new UndoHistory(() => (now += 2000));
  const answer: { resolve?: () => void; reject?: (error: Error) => void } = {};
  const host = hostWith(history, {
    rpc: {
      request: () =>
        new Promise<unknown>((resolve, reject) => {
          answer.resolve = () => resolve({ name: "garden" });
          answer.reject = reject;
        }),
    } as unknown as Host["rpc"],
    viewer: () => "viewer-1",
    viewState: () => ({ scene: "hall" }),
    show: (state) => void undone.push(`to ${state.scene}`),
    sceneChanged: () => Promise.resolve(),
    reportFile: () => {},
    inform: () => {},
  });
  const loading = new SceneLoading(host);
  const move = (label: string): void =>
    history.add({
      label,
      key: "camera",
      ofScene: true,
      undo: () => void undone.push(label),
      redo: () => {},
    });
  move("in hall");
  const loaded = loading.load("garden");
  loading.progressed(progress("textures", true));
  return { history, loading, loaded, answer, move, undone };
}

test("steps of the scene before cannot be undone while another one is seen", async () => {
  const { history, loading, answer, loaded, move, undone } = entering();
  assert.equal(await history.undo(), null);
  assert.deepEqual(history.next.value, { undo: null, redo: null });
  assert.equal(loading.seesAnother, true);
  move("in garden");
  assert.equal(history.next.value.undo, "in garden");
  answer.resolve?.();
  await loaded;
  assert.equal(await history.undo(), "in garden");
  assert.equal(await history.undo(), "scene garden");
  assert.equal(await history.undo(), "in hall");
  assert.deepEqual(undone, ["in garden", "to hall", "in hall"]);
});

test("steps in a scene that does not arrive are gone", async () => {
  const { history, loading, answer, loaded, move, undone } = entering();
  move("in garden");
  loading.progressed(progress("failed", false));
  assert.equal(loading.seesAnother, false);
  answer.reject?.(new Error("damaged"));
  await loaded;
  assert.deepEqual(history.next.value, { undo: "in hall", redo: null });
  history.undo();
  assert.deepEqual(undone, ["in hall"]);
});
