import assert from "node:assert/strict";
import test from "node:test";
import type { Vector3 } from "heliograph/json.ts";
import { PatchSender } from "../src/common/patch_sender.ts";
import { displayColour, linearColour } from "../src/common/colour.ts";
import { sunDirection, sunPosition } from "../src/panel/scene/sun_dial.ts";
import { editsBetween } from "../src/session/scene_edits.ts";

test("a sun high in the south-east shines down to the north-west", () => {
  const direction = sunDirection({ azimuth: 135, elevation: 45 });
  const expected = [-0.5, -Math.SQRT1_2, -0.5];
  direction.forEach((value, axis) => assert.ok(Math.abs(value - expected[axis]!) < 1e-9));
  const { azimuth, elevation } = sunPosition(direction);
  assert.ok(Math.abs(azimuth - 135) < 1e-9 && Math.abs(elevation - 45) < 1e-9);
});

test("colours are unchanged after a round trip through a colour input", () => {
  for (const colour of ["#000000", "#ffffff", "#0a80f3"]) {
    assert.equal(displayColour(linearColour(colour)), colour);
  }
  const grey: Vector3 = [0.2158605, 0.2158605, 0.2158605];
  assert.equal(displayColour(grey), "#808080");
});

test("patches of one object are merged during a call, others are sent at once", async () => {
  const sent: string[] = [];
  const finish: (() => void)[] = [];
  const sender = new PatchSender((key, patch) => {
    sent.push(`${key} ${JSON.stringify(patch)}`);
    return new Promise((resolve) => finish.push(resolve));
  });
  sender.push("sun", { intensity: 1 });
  sender.push("sun", { intensity: 2 });
  sender.push("sun", { enabled: false });
  sender.push("bulb", { intensity: 3 });
  assert.deepEqual(sent, ['sun {"intensity":1}', 'bulb {"intensity":3}']);
  assert.equal(sender.isBusy("sun"), true);
  finish.splice(0).forEach((done) => done());
  await new Promise((resolve) => setTimeout(resolve, 0));
  assert.equal(sent[2], 'sun {"intensity":2,"enabled":false}');
  finish.splice(0).forEach((done) => done());
  await new Promise((resolve) => setTimeout(resolve, 0));
  assert.equal(sender.isBusy("sun"), false);
});

test("edits between two states contain changes, and nulls for what was reset", () => {
  const before = { sun: { intensity: 2, enabled: false }, bulb: { intensity: 3 } };
  const after = { sun: { intensity: 2.5 }, bulb: { intensity: 3 }, spot: { radius: 0.1 } };
  assert.deepEqual(editsBetween(before, after), {
    sun: { enabled: null, intensity: 2.5 },
    spot: { radius: 0.1 },
  });
  assert.deepEqual(editsBetween(before, {}), {
    sun: { intensity: null, enabled: null },
    bulb: { intensity: null },
  });
  assert.deepEqual(editsBetween(before, before), {});
});
