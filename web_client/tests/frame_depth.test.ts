import assert from "node:assert/strict";
import test from "node:test";
import zlib from "node:zlib";
import { readFrameDepth } from "heliograph/frame_depth.ts";
import { FrameFlag, FrameFormatError, parseFrameHeader } from "heliograph/frame_header.ts";

/** The message of a frame whose depth plane, 2 wide, has these differences. */
function message(differences: number[], planeBytes?: number): ArrayBuffer {
  const plane = zlib.deflateSync(Uint8Array.from(differences));
  const end = 116 + plane.length;
  const bytes = new ArrayBuffer(end + 4);
  const view = new DataView(bytes);
  view.setUint32(0, 0x46525648, true);
  view.setUint8(4, 1);
  view.setUint8(5, 1);
  view.setUint8(6, 1);
  view.setUint8(7, FrameFlag.depth);
  view.setUint16(8, end, true);
  view.setUint16(64, 2, true);
  view.setUint16(66, differences.length / 4, true);
  [0.5, 1, 2, 3, 4, 5, 6, 0, 1, 0, 40].forEach((value, index) => {
    view.setFloat32(68 + 4 * index, value, true);
  });
  view.setUint32(112, planeBytes ?? plane.length, true);
  new Uint8Array(bytes).set(plane, 116);
  return bytes;
}

test("a frame's depth is its camera and the samples that its differences add up to", async () => {
  // 515, then -2; 0 below the first, where -515 is the difference, then what the plane predicts.
  const bytes = message([0x06, 0x03, 0x05, 0x00, 0x04, 0x00, 0x04, 0x00]);
  const depth = await readFrameDepth(bytes, parseFrameHeader(bytes));
  assert.deepEqual(depth && [...depth.samples], [515, 513, 0, 65534]);
  assert.deepEqual(depth?.eye, [1, 2, 3]);
  assert.deepEqual(depth?.target, [4, 5, 6]);
  assert.deepEqual(depth?.up, [0, 1, 0]);
  assert.deepEqual([depth?.nearest, depth?.verticalFov], [0.5, 40]);
  assert.deepEqual([depth?.width, depth?.height], [2, 2]);
});

test("frames without the flag have no depth", async () => {
  const bytes = message([0, 0, 0, 0]);
  new DataView(bytes).setUint8(7, 0);
  assert.equal(await readFrameDepth(bytes, parseFrameHeader(bytes)), null);
});

test("depth that does not fit its header is an error", async () => {
  const read = (bytes: ArrayBuffer) => readFrameDepth(bytes, parseFrameHeader(bytes));
  await assert.rejects(read(message([0, 0, 0, 0], 1000)), FrameFormatError);
  const wrongSize = message([0, 0, 0, 0]);
  new DataView(wrongSize).setUint16(66, 7, true);
  await assert.rejects(read(wrongSize), FrameFormatError);
});
