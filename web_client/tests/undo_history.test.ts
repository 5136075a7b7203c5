import assert from "node:assert/strict";
import test from "node:test";
import { UndoHistory, inverseOf } from "../src/session/undo_history.ts";

test("the inverse of a patch holds the previous values, and only those", () => {
  const tree = { taa: { enabled: true, frames: 8 }, seed: 3 };
  assert.deepEqual(inverseOf({ taa: { enabled: false } }, tree), { taa: { enabled: true } });
  assert.deepEqual(inverseOf({ seed: null }, tree), { seed: 3 });
});

test("a drag is one step, another setting is another", () => {
  let now = 0;
  const history = new UndoHistory(() => now);
  for (const value of [1, 2, 3]) {
    history.add({ a: { b: value } }, { a: { b: value - 1 } });
    now += 100;
  }
  history.add({ a: { c: 1 } }, { a: { c: 0 } });
  assert.deepEqual(history.undo(), { a: { c: 0 } });
  assert.deepEqual(history.undo(), { a: { b: 0 } });
  assert.equal(history.undo(), null);
  assert.deepEqual(history.redo(), { a: { b: 3 } });
  now += 100;
  history.add({ a: { b: 9 } }, { a: { b: 3 } });
  assert.equal(history.canRedo, false);
  assert.deepEqual(history.undo(), { a: { b: 3 } });
});
