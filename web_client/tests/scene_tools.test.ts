import assert from "node:assert/strict";
import test from "node:test";
import type { Vector3 } from "heliograph/messages.ts";
import { PatchSender } from "../src/common/patch_sender.ts";
import { displayColour, linearColour } from "../src/panel/scene/material_section.ts";
import { editsBetween } from "../src/session/scene_edits.ts";
import { sunDirection, sunPosition } from "../src/panel/scene/sun_dial.ts";

test("a sun high in the south-east shines down to the north-west", () => {
  const direction = sunDirection({ azimuth: 135, elevation: 45 });
  const expected = [-0.5, -Math.SQRT1_2, -0.5];
  direction.forEach((value, axis) => assert.ok(Math.abs(value - expected[axis]!) < 1e-9));
  const { azimuth, elevation } = sunPosition(direction);
  assert.ok(Math.abs(azimuth - 135) < 1e-9 && Math.abs(elevation - 45) < 1e-9);
});

test("colours survive the way through a colour input", () => {
  for (const colour of ["#000000", "#ffffff", "#0a80f3"]) {
    assert.equal(displayColour(linearColour(colour)), colour);
  }
  const grey: Vector3 = [0.2158605, 0.2158605, 0.2158605];
  assert.equal(displayColour(grey), "#808080");
});

test("patches of one thing are joined while one is under way, others go at once", async () => {
  const sent: string[] = [];
  const finish: (() => void)[] = [];
  const sender = new PatchSender((key, patch) => {
    sent.push(`${key} ${JSON.stringify(patch)}`);
    return new Promise((resolve) => finish.push(resolve));
  });
  sender.push("sun", { intensity: 1 });
  sender.push("sun", { intensity: 2 });
  sender.push("sun", { enabled: false });
  sender.push("lamp", { intensity: 3 });
  assert.deepEqual(sent, ['sun {"intensity":1}', 'lamp {"intensity":3}']);
  assert.equal(sender.unsettled("sun"), true);
  finish.splice(0).forEach((done) => done());
  await new Promise((resolve) => setTimeout(resolve, 0));
  assert.equal(sent[2], 'sun {"intensity":2,"enabled":false}');
  finish.splice(0).forEach((done) => done());
  await new Promise((resolve) => setTimeout(resolve, 0));
  assert.equal(sender.unsettled("sun"), false);
});

test("what follows a scene's edits is told what is new, and what is as in the file again", () => {
  const before = { sun: { intensity: 2, enabled: false }, lamp: { intensity: 3 } };
  const after = { sun: { intensity: 2.5 }, lamp: { intensity: 3 }, spot: { radius: 0.1 } };
  assert.deepEqual(editsBetween(before, after), {
    sun: { enabled: null, intensity: 2.5 },
    spot: { radius: 0.1 },
  });
  assert.deepEqual(editsBetween(before, {}), {
    sun: { intensity: null, enabled: null },
    lamp: { intensity: null },
  });
  assert.deepEqual(editsBetween(before, before), {});
});
