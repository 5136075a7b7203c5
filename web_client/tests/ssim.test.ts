import assert from "node:assert/strict";
import test from "node:test";
import { type GreyImage, greyImage, structuralSimilarity } from "../src/compare/ssim.ts";

const size = 32;
const image = (of: (x: number, y: number) => number): GreyImage => ({
  width: size,
  height: size,
  luma: Float32Array.from({ length: size * size }, (_, i) => of(i % size, Math.floor(i / size))),
});
const waves = image((x, y) => 128 + 60 * Math.sin(x / 2) * Math.cos(y / 3));

test("the similarity is 1 for equal images and falls with noise", () => {
  assert.equal(structuralSimilarity(waves, waves), 1);
  const noisy = (amount: number) => ({
    ...waves,
    luma: waves.luma.map((value, i) => value + amount * Math.sin(i * 12.9898)),
  });
  const slight = structuralSimilarity(waves, noisy(4));
  const strong = structuralSimilarity(waves, noisy(40));
  assert.ok(slight > 0.9 && slight < 1, String(slight));
  assert.ok(strong < 0.8 && strong < slight, String(strong));
});

test("uniform images are compared by their mean alone", () => {
  const [a, b] = [100, 150];
  const c1 = (0.01 * 255) ** 2;
  const expected = (2 * a * b + c1) / (a * a + b * b + c1);
  const found = structuralSimilarity(
    image(() => a),
    image(() => b),
  );
  assert.ok(Math.abs(found - expected) < 1e-6);
});

test("luma weighs green most", () => {
  const { luma } = greyImage(Uint8ClampedArray.from([255, 0, 0, 255, 0, 255, 0, 255]), 2, 1);
  assert.ok(Math.abs(luma[0]! - 54.2) < 0.1 && Math.abs(luma[1]! - 182.4) < 0.1);
});
