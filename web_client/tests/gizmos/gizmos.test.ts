import assert from "node:assert/strict";
import test from "node:test";
import type { Vector3 } from "heliograph/json.ts";
import type { LightInfo, SceneInfo, SectionPlane } from "heliograph/messages.ts";
import { Signal } from "../../src/common/signal.ts";
import { dot, length, normalize, subtract } from "../../src/common/vector.ts";
import { lightGizmo } from "../../src/gizmos/light_gizmo.ts";
import { PlaneGizmos } from "../../src/gizmos/plane_gizmo.ts";
import { planeQuad } from "../../src/gizmos/plane_shape.ts";
import { HandleChoice } from "../../src/session/handle_choice.ts";

const bounds: SceneInfo["bounds"] = { min: [-1, 0, -2], max: [3, 2, 2] };
const scene = { name: "room", bounds };

function near(actual: Vector3, expected: Vector3): void {
  assert.ok(length(subtract(actual, expected)) < 1e-9, `${actual}, not ${expected}`);
}

test("the rectangle of a plane lies in it and surrounds the scene", () => {
  const quad = planeQuad({ normal: [0, 1, 0], offset: 0.5 }, bounds);
  assert.equal(quad.length, 4);
  const [low, high] = [Math.min, Math.max].map((pick) =>
    [0, 1, 2].map((axis) => pick(...quad.map((corner) => corner[axis] as number))),
  );
  assert.ok(Math.abs(low![1]! - 0.5) < 1e-9 && Math.abs(high![1]! - 0.5) < 1e-9);
  assert.ok(low![0]! < -1 && low![0]! > -1.3 && high![0]! > 3 && high![2]! > 2 && low![2]! < -2);
  const normal = normalize([1, 2, -0.5]);
  for (const corner of planeQuad({ normal, offset: 1 }, bounds)) {
    assert.ok(Math.abs(dot(normal, corner) - 1) < 1e-9);
  }
});

test("the rectangle of a plane through a point has a size", () => {
  const quad = planeQuad({ normal: [0, 0, 1], offset: 0 }, { min: [0, 0, 0], max: [0, 0, 0] });
  assert.ok(length(subtract(quad[0] as Vector3, quad[1] as Vector3)) > 0.1);
});

/** A store of planes that counts the steps of its history. */
function planeStore(...initial: SectionPlane[]) {
  const planes = new Signal<readonly SectionPlane[]>(initial);
  const steps: string[] = [];
  return {
    planes,
    steps,
    preview: (all: readonly SectionPlane[]) => planes.set(all),
    record: (_: readonly SectionPlane[], label: string) => void steps.push(label),
  };
}

test("a plane moves along its normal within the scene, as one step", () => {
  const store = planeStore({ normal: [0, 1, 0], offset: 1, enabled: true });
  const gizmo = new PlaneGizmos(store).of(0, scene)!;
  near(gizmo.pose.anchor, [1, 1, 0]);
  const edit = gizmo.begin("along");
  edit.show({ ...gizmo.pose, anchor: [1, 1.5, 0] });
  edit.show({ ...gizmo.pose, anchor: [1, 7, 0] });
  assert.deepEqual(store.planes.value, [{ normal: [0, 1, 0], offset: 2, enabled: true }]);
  assert.deepEqual(store.steps, []);
  edit.keep("drag 1");
  assert.deepEqual(store.steps, ["move section plane 1"]);
});

test("a drag that is taken back leaves the plane and the history as they were", () => {
  const before: SectionPlane = { normal: [0, 1, 0], offset: 1 };
  const store = planeStore(before);
  const gizmo = new PlaneGizmos(store).of(0, scene)!;
  const edit = gizmo.begin("along");
  edit.show({ ...gizmo.pose, anchor: [1, 1.5, 0] });
  edit.revert();
  assert.deepEqual(store.planes.value, [before]);
  gizmo.begin("along").keep("drag 2");
  assert.deepEqual(store.steps, [], "a press without a drag is no step");
});

test("a plane is turned about its handles, which stay where they are", () => {
  const store = planeStore({ normal: [0, 1, 0], offset: 1.5 });
  const gizmos = new PlaneGizmos(store);
  const { anchor } = gizmos.of(0, scene)!.pose;
  for (const direction of [[0.6, 0.8, 0], [0, 0.6, 0.8]] as Vector3[]) {
    gizmos.of(0, scene)!.begin("turn").show({ anchor, direction });
    const { normal, offset } = store.planes.value[0]!;
    near(normal, direction);
    assert.ok(Math.abs(dot(normal, anchor) - offset) < 1e-9);
    near(gizmos.of(0, scene)!.pose.anchor, anchor);
  }
  assert.equal(gizmos.of(1, scene), null);
});

const light = (parts: Partial<LightInfo>): LightInfo => ({
  name: "sun",
  type: "point",
  added: false,
  changed: [],
  color: [1, 1, 1],
  enabled: true,
  intensity: 1,
  ...parts,
});

test("lights have the handles that their types need", () => {
  const store = { previewLight: () => {}, recordLight: () => {}, restoreLight: () => {} };
  const ids = (one: LightInfo): string[] =>
    lightGizmo(one, bounds, store).handles.map(({ id }) => id);
  const position: Vector3 = [0, 1, 0];
  const direction: Vector3 = [0, -2, 0];
  assert.deepEqual(ids(light({ position })), ["x", "y", "z", "centre"]);
  assert.deepEqual(ids(light({ type: "spot", position, direction })).at(-1), "turn");
  const sun = lightGizmo(light({ type: "directional", direction }), bounds, store);
  assert.deepEqual(sun.handles.map(({ id, label }) => [id, label]), [["turn", "Turn sun"]]);
  near(sun.pose.anchor, [1, 1, 0]);
  near(sun.pose.direction as Vector3, [0, -1, 0]);
});

test("a light's drag changes one member and is one step with a name", () => {
  const calls: unknown[] = [];
  const before = light({ position: [0, 1, 0] });
  const gizmo = lightGizmo(before, bounds, {
    previewLight: (name, patch) => void calls.push([name, patch]),
    recordLight: (_, patch, label) => void calls.push([label, patch]),
    restoreLight: (one, members) => void calls.push([one.name, members]),
  });
  const edit = gizmo.begin("along");
  edit.show({ anchor: [1, 1, 0], direction: null });
  edit.keep("drag 1");
  edit.revert();
  assert.deepEqual(calls, [
    ["sun", { position: [1, 1, 0] }],
    ["move light sun", { position: [1, 1, 0] }],
    ["sun", ["position"]],
  ]);
});

test("handles are those of the chosen part while its list can be seen", () => {
  const planes = new Signal<readonly SectionPlane[]>([]);
  const lights = new Signal<LightInfo[]>([light({ position: [0, 0, 0] })]);
  const shown = new Signal<SceneInfo | null>(null);
  const choice = new HandleChoice({ scene: shown, section: { planes }, parts: { lights } });
  const plane = (index: number) => ({ kind: "plane", index }) as const;
  choice.setListed("light", true);
  assert.equal(choice.target.value, null, "no light before a choice");
  choice.choose({ kind: "light", name: "sun" });
  assert.deepEqual(choice.target.value, { kind: "light", name: "sun" });
  choice.setListed("light", false);
  assert.equal(choice.target.value, null);
  choice.setListed("plane", true);
  planes.set([{ normal: [1, 0, 0], offset: 0 }]);
  assert.deepEqual(choice.target.value, plane(0), "the only plane");
  choice.toggle(plane(0));
  assert.equal(choice.target.value, null);
  planes.set(Array(3).fill({ normal: [1, 0, 0], offset: 0 }));
  choice.toggle(plane(2));
  choice.planeRemoved(0);
  planes.set(planes.value.slice(1));
  assert.deepEqual(choice.target.value, plane(1), "the same plane has another index");
  planes.set([]);
  assert.equal(choice.target.value, null);
});
