import assert from "node:assert/strict";
import test from "node:test";
import { nameOf } from "../src/overlay/upload.ts";
import { codecString } from "../src/stream/annex_b.ts";

test("the codec string comes from the first sequence parameter set", () => {
  const delimiter = [0, 0, 0, 1, 0x09, 0x10];
  const parameters = [0, 0, 0, 1, 0x67, 0x42, 0xc0, 0x2a, 0xda, 0x01];
  assert.equal(codecString(Uint8Array.from([...delimiter, ...parameters])), "avc1.42c02a");
  assert.equal(codecString(Uint8Array.from([...delimiter, 0, 0, 1, 0x41, 1, 2, 3])), null);
});

test("file names become valid scene names", () => {
  assert.equal(nameOf("My model (1).glb"), "My_model_1");
  assert.equal(nameOf("../../x.glb"), "x");
  assert.equal(nameOf(".glb"), "scene");
});
