import assert from "node:assert/strict";
import test from "node:test";
import { MultipartReader } from "../src/stream/multipart.ts";

const head = "--picture\r\nContent-Type: image/jpeg\r\n\r\n";
const stream = `${head}first\r\n-\r\n\r\n--pic\r\n${head}second\r\n${head}third\r\n--picture--\r\n`;
const bytes = new TextEncoder().encode(stream);

function partsIn(step: number): string[] {
  const splitter = new MultipartReader("picture");
  const parts: string[] = [];
  for (let at = 0; at < bytes.length; at += step) {
    const part = splitter.push(bytes.subarray(at, at + step));
    if (part) parts.push(new TextDecoder().decode(part));
  }
  return parts;
}

test("parts are whole wherever the bytes are cut", () => {
  for (const step of [1, 2, 3, 7, 20]) {
    assert.deepEqual(partsIn(step), ["first\r\n-\r\n\r\n--pic", "second", "third"], `${step}`);
  }
});

test("of several parts at once the newest is given", () => {
  assert.deepEqual(partsIn(bytes.length), ["third"]);
});
