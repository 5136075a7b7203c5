import assert from "node:assert/strict";
import test from "node:test";
import { joinPatches, mergePatch, patchOf, sameValue, valueAt } from "heliograph/settings_tree.ts";

test("paths lead to values and patches", () => {
  assert.equal(valueAt({ a: { b: [1] } }, "a.c"), undefined);
  assert.deepEqual(valueAt({ a: { b: [1] } }, "a.b"), [1]);
  assert.deepEqual(patchOf("a.b.c", null), { a: { b: { c: null } } });
});

test("merging replaces members, keeps others and resets nulls to defaults", () => {
  const tree = { a: { x: 1, y: 2 }, b: 3 };
  const defaults = { a: { x: 0, y: 0 }, b: 9 };
  assert.deepEqual(mergePatch(tree, { a: { x: 5 } }, defaults), { a: { x: 5, y: 2 }, b: 3 });
  assert.deepEqual(mergePatch(tree, { a: { y: null } }, defaults), { a: { x: 1, y: 0 }, b: 3 });
  assert.deepEqual(mergePatch(tree, { a: null }, defaults), { a: { x: 0, y: 0 }, b: 3 });
  assert.deepEqual(mergePatch(tree, { c: { d: 1 } }, defaults), { ...tree, c: { d: 1 } });
  assert.deepEqual(tree, { a: { x: 1, y: 2 }, b: 3 });
});

test("joined patches keep both parts, the later value and its nulls", () => {
  const joined = joinPatches({ a: { x: 1, y: 2 } }, { a: { y: null }, b: true });
  assert.deepEqual(joined, { a: { x: 1, y: null }, b: true });
});

test("values are equal after a round trip through single precision", () => {
  assert.ok(sameValue(Math.fround(0.1), 0.1));
  assert.ok(!sameValue(0.1, 0.1001));
  assert.ok(sameValue([1, 2], [1, 2]));
  assert.ok(!sameValue([1, 2], [1, 2, 3]));
  assert.ok(!sameValue(true, 1));
});
