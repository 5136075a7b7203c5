// What is compared with this session, and the result so far.

import type { DrawnFrame } from "../stream/worker_messages.ts";

export type Counterpart =
  { kind: "reference" } | { kind: "preset"; name: string } | { kind: "buffer"; name: string };

export interface ComparisonState {
  counterpart: Counterpart;
  /** Its newest frame; null before the first. */
  frame: DrawnFrame | null;
  /** Structural similarity of both frames; null before the first measurement. */
  similarity: number | null;
}
