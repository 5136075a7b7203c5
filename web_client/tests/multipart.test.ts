import assert from "node:assert/strict";
import test from "node:test";
import { MultipartReader } from "../src/stream/multipart.ts";

const head = "--frame\r\nContent-Type: image/jpeg\r\n\r\n";
const stream = `${head}first\r\n-\r\n\r\n--fra\r\n${head}second\r\n${head}third\r\n--frame--\r\n`;
const bytes = new TextEncoder().encode(stream);

function partsIn(step: number): string[] {
  const reader = new MultipartReader("frame");
  const parts: string[] = [];
  for (let at = 0; at < bytes.length; at += step) {
    const part = reader.push(bytes.subarray(at, at + step));
    if (part) parts.push(new TextDecoder().decode(part));
  }
  return parts;
}

test("parts are complete for every chunk size", () => {
  for (const step of [1, 2, 3, 7, 20]) {
    assert.deepEqual(partsIn(step), ["first\r\n-\r\n\r\n--fra", "second", "third"], `${step}`);
  }
});

test("of several parts in one chunk the newest is returned", () => {
  assert.deepEqual(partsIn(bytes.length), ["third"]);
});
