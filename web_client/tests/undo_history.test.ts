import assert from "node:assert/strict";
import test from "node:test";
import { UndoHistory } from "../src/session/history/undo_history.ts";
import { inverseOf, pathsOf } from "../src/session/history/settings_steps.ts";

test("the inverse of a patch holds the previous values, and only those", () => {
  const tree = { taa: { enabled: true, frames: 8 }, seed: 3 };
  assert.deepEqual(inverseOf({ taa: { enabled: false } }, tree), { taa: { enabled: true } });
  assert.deepEqual(inverseOf({ seed: null }, tree), { seed: 3 });
  assert.deepEqual(pathsOf({ taa: { enabled: false }, seed: null }), ["taa.enabled", "seed"]);
});

/** A history of numbers by name. */
function numbers() {
  let now = 0;
  const values: Record<string, number> = {};
  const history = new UndoHistory(() => now);
  const change = (name: string, value: number, ofScene = false, movement?: number): void => {
    const before = values[name] ?? 0;
    const set = (to: number) => () => void (values[name] = to);
    set(value)();
    const [undo, redo] = [set(before), set(value)];
    history.add({ label: name, key: name, ofScene, movement, undo, redo });
  };
  return { values, history, change, wait: (ms: number) => (now += ms) };
}

test("a drag is one step, another value is another, and steps have names", () => {
  const { values, history, change, wait } = numbers();
  for (const value of [1, 2, 3]) {
    change("exposure", value);
    wait(100);
  }
  change("sun", 5);
  assert.deepEqual(history.next.value, { undo: "sun", redo: null });
  assert.equal(history.undo(), "sun");
  assert.deepEqual(history.next.value, { undo: "exposure", redo: "sun" });
  assert.equal(history.undo(), "exposure");
  assert.deepEqual(values, { exposure: 0, sun: 0 });
  assert.equal(history.undo(), null);
  assert.equal(history.redo(), "exposure");
  assert.equal(values.exposure, 3);
  wait(100);
  change("exposure", 9);
  assert.deepEqual(history.next.value, { undo: "exposure", redo: null });
  history.undo();
  assert.equal(values.exposure, 3);
});

test("a movement is one step on a slow page, too, and the next one is another", () => {
  const { values, history, change, wait } = numbers();
  for (const value of [1, 2, 3]) {
    change("camera", value, true, 0);
    wait(2000);
  }
  change("camera", 7, true, 1);
  history.undo();
  assert.equal(values.camera, 3);
  history.undo();
  assert.equal(values.camera, 0);
  history.redo();
  change("camera", 4, true, 0);
  history.undo();
  assert.equal(values.camera, 3, "what was redone is complete");
});

test("what was undone before a scene was seen that does not stay can be done again", () => {
  const { values, history, change } = numbers();
  change("sun", 5, true);
  history.undo();
  history.enterScene();
  assert.deepEqual(history.next.value, { undo: null, redo: null });
  history.leaveScene();
  assert.deepEqual(history.next.value, { undo: null, redo: "sun" });
  history.redo();
  history.enterScene();
  change("camera", 3, true);
  change("exposure", 2);
  history.leaveScene();
  history.undo();
  assert.equal(values.exposure, 0, "settings stay whatever is seen");
  assert.equal(history.undo(), "sun");
});

test("steps in a scene that another viewer loads stay, those of the one before do not", () => {
  const { history, change } = numbers();
  change("sun", 5, true);
  history.enterScene();
  change("camera", 3, true);
  history.dropScene();
  assert.equal(history.undo(), "camera");
  assert.equal(history.undo(), null);
});

test("steps in a scene are void when another viewer loads another scene", () => {
  const { values, history, change } = numbers();
  change("exposure", 1);
  change("sun", 5, true);
  history.undo();
  history.dropScene();
  assert.deepEqual(history.next.value, { undo: "exposure", redo: null });
  history.undo();
  assert.deepEqual(values, { exposure: 0, sun: 0 });
});

test("undo waits for the answer to a change that may add a step", async () => {
  const { values, history, change } = numbers();
  change("exposure", 1);
  let answer = (): void => {};
  const answered = new Promise<void>((resolve) => (answer = resolve));
  const applied = history.during(answered.then(() => change("sun", 5)));
  history.whenKnown(() => void history.undo());
  assert.equal(values.exposure, 1, "the step before is not undone in its place");
  answer();
  await applied;
  assert.deepEqual(values, { exposure: 1, sun: 0 });
  assert.deepEqual(history.next.value, { undo: "exposure", redo: "sun" });
});

test("undo that waited for a refused change undoes the step before", async () => {
  const { values, history, change } = numbers();
  change("exposure", 1);
  const refused = history.during(Promise.reject(new Error("refused")));
  history.whenKnown(() => void history.undo());
  await assert.rejects(refused);
  assert.equal(values.exposure, 0);
});

test("undo that waits is dropped with the history", async () => {
  const { values, history, change } = numbers();
  const ended = history.during(Promise.resolve());
  history.whenKnown(() => void history.undo());
  history.clear();
  change("exposure", 1);
  await ended;
  assert.equal(values.exposure, 1);
});
