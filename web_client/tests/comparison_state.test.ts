import assert from "node:assert/strict";
import test from "node:test";
import { describeComparison, samplesNeeded } from "../src/compare/comparison_state.ts";

const preset = { kind: "preset", name: "svgf" } as const;

test("a comparison tells what it prepares and shows no figure before both have enough samples", () => {
  const told = (samples: number | null, similarity: number | null) =>
    describeComparison({ counterpart: preset, samples, similarity }, 1024);
  assert.equal(told(null, null), "Preparing: starting the second session");
  assert.equal(told(7, 0.5), "Preparing: 7 of 32 samples");
  assert.equal(told(32, null), "Preparing: measuring");
  assert.equal(told(40, 0.98765), "Similarity (SSIM) 0.9877 with 40 samples");
});

test("a view that converges with fewer samples needs no more than these", () => {
  assert.equal(samplesNeeded({ kind: "reference" }, 1024), 64);
  assert.equal(samplesNeeded({ kind: "reference" }, 16), 16);
  assert.equal(samplesNeeded(preset, 0), 1);
});
