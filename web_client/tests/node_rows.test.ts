import assert from "node:assert/strict";
import test from "node:test";
import type { NodeInfo } from "heliograph/messages.ts";
import { hierarchyOf, matchesOf, rowsOf } from "../src/panel/nodes/node_rows.ts";

const node = (id: number, parent: number | null, name: string): NodeInfo => ({
  id,
  parent,
  name,
  meshes: 1,
  visible: true,
});
const car = [
  node(0, null, "car"),
  node(1, 0, "body"),
  node(2, 0, "wheels"),
  node(3, 2, "front wheel"),
  node(4, null, "road"),
  node(5, 1, "door"), // appended later, as instances are
];
const all = (): boolean => true;
const ids = (rows: { node: NodeInfo }[]): number[] => rows.map((row) => row.node.id);

test("rows follow the hierarchy and leave out what is folded", () => {
  const hierarchy = hierarchyOf(car);
  const rows = rowsOf(car, hierarchy, all, null);
  assert.deepEqual(ids(rows), [0, 1, 5, 2, 3, 4]);
  assert.deepEqual(
    rows.map(({ level }) => level),
    [1, 2, 3, 2, 3, 1],
  );
  assert.deepEqual(
    rows.map(({ open }) => open),
    [true, true, null, true, null, null],
  );
  assert.deepEqual(ids(rowsOf(car, hierarchy, (id) => id !== 2, null)), [0, 1, 5, 2, 4]);
});

test("a search lists what it finds with all above it, unfolded", () => {
  const found = matchesOf(car, "FRONT");
  assert.deepEqual(ids(rowsOf(car, hierarchyOf(car), () => false, found)), [0, 2, 3]);
  assert.deepEqual(ids(rowsOf(car, hierarchyOf(car), all, matchesOf(car, "boat"))), []);
});

test("100,000 nodes take no time that one would notice", () => {
  const many = Array.from({ length: 100_000 }, (_, i) =>
    node(i, i === 0 ? null : Math.floor((i - 1) / 40), `part ${i}`),
  );
  const started = performance.now();
  const hierarchy = hierarchyOf(many);
  assert.equal(rowsOf(many, hierarchy, all, null).length, many.length);
  assert.ok(rowsOf(many, hierarchy, all, matchesOf(many, "99")).length > 1000);
  const took = performance.now() - started;
  assert.ok(took < 1500, `${took.toFixed(0)} ms`);
});
