// What is compared with this session, and the result so far.

export type Counterpart =
  { kind: "reference" } | { kind: "preset"; name: string } | { kind: "buffer"; name: string };

export interface ComparisonState {
  counterpart: Counterpart;
  /** Samples per pixel of the frame that has fewer of them; null before both show the same view. */
  samples: number | null;
  /** Structural similarity of both frames; null until both have enough samples. */
  similarity: number | null;
}

/** With fewer samples the figure would tell about noise, not about the methods that are compared. */
const enoughSamples = { reference: 64, preset: 32, buffer: 1 };

/** How many samples both frames need; a static view has no more than `maxSamples`. */
export function samplesNeeded({ kind }: Counterpart, maxSamples: number): number {
  return Math.min(enoughSamples[kind], Math.max(1, maxSamples));
}

/** The state in words; empty where there is nothing to tell. */
export function describeComparison(state: ComparisonState, maxSamples: number): string {
  const { counterpart, samples, similarity } = state;
  if (counterpart.kind === "buffer") return samples === null ? "Preparing the buffer" : "";
  if (samples === null) return "Preparing: starting the second session";
  const needed = samplesNeeded(counterpart, maxSamples);
  if (samples < needed) return `Preparing: ${samples} of ${needed} samples`;
  if (similarity === null) return "Preparing: measuring";
  return `Similarity (SSIM) ${similarity.toFixed(4)} with ${samples} samples`;
}
