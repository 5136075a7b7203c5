import assert from "node:assert/strict";
import test from "node:test";
import { FrameFormatError, mimeType, parseFrameHeader } from "heliograph/frame_header.ts";

function message(headerBytes = 64, payload = 10): ArrayBuffer {
  const buffer = new ArrayBuffer(headerBytes + payload);
  new Uint8Array(buffer).set([0x48, 0x56, 0x52, 0x46, 1, 1, 1, 3]); // "HVRF"
  const view = new DataView(buffer);
  view.setUint16(8, headerBytes, true);
  view.setUint16(10, 85, true);
  view.setUint32(12, 7, true);
  view.setUint32(16, 1000, true);
  view.setUint32(20, 0xfffffffe, true);
  view.setUint32(24, 12, true);
  [640, 360, 1, 2, 1280, 720].forEach((value, i) => view.setUint16(28 + 2 * i, value, true));
  view.setBigUint64(40, 5_000_000_000n, true);
  [1500, 2500, 30, 64].forEach((value, i) => view.setUint32(48 + 4 * i, value, true));
  return buffer;
}

test("every field is read from its offset", () => {
  assert.deepEqual(parseFrameHeader(message()), {
    type: 1,
    codec: 1,
    flags: 3,
    headerBytes: 64,
    quality: 85,
    frameSeq: 7,
    renderId: 1000,
    inputSeqEcho: 0xfffffffe,
    stateRev: 12,
    width: 640,
    height: 360,
    x: 1,
    y: 2,
    fullWidth: 1280,
    fullHeight: 720,
    renderStartUs: 5_000_000_000,
    renderUs: 1500,
    encodeUs: 2500,
    queueUs: 30,
    sampleCount: 64,
  });
});

test("a longer header of a later server is skipped, not rejected", () => {
  assert.equal(parseFrameHeader(message(96)).headerBytes, 96);
});

test("an invalid frame is rejected with a reason", () => {
  const truncated = message().slice(0, 63);
  assert.throws(() => parseFrameHeader(truncated), /no full header/);
  const otherMagic = message();
  new Uint8Array(otherMagic)[0] = 0x58;
  assert.throws(() => parseFrameHeader(otherMagic), FrameFormatError);
  const otherVersion = message();
  new Uint8Array(otherVersion)[4] = 2;
  assert.throws(() => parseFrameHeader(otherVersion), /version 2/);
  const tooLong = message();
  new DataView(tooLong).setUint16(8, 5000, true);
  assert.throws(() => parseFrameHeader(tooLong), /claims 5000 bytes/);
  const tooShort = message();
  new DataView(tooShort).setUint16(8, 32, true);
  assert.throws(() => parseFrameHeader(tooShort), /claims 32 bytes/);
});

test("image codecs have a MIME type and video codecs have none", () => {
  assert.equal(mimeType(1), "image/jpeg");
  assert.equal(mimeType(2), "image/png");
  assert.equal(mimeType(16), null);
});
