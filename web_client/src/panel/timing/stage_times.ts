// Groups the passes of a frame into stages by the first part of the pass name.

import type { FrameStats, PassTiming } from "heliograph/messages.ts";

export interface Stage {
  name: string;
  ms: number;
  passes: PassTiming[];
}

/** In the order of the frame; the encoder, which runs in parallel, comes last. */
export function stagesOf(stats: FrameStats): Stage[] {
  const stages = new Map<string, Stage>();
  const passes = [...stats.passes, { name: "encode", kind: "host", ms: stats.encode_ms } as const];
  for (const pass of passes) {
    const name = pass.name.split(".", 1)[0] ?? pass.name;
    const stage = stages.get(name) ?? { name, ms: 0, passes: [] };
    stage.ms += pass.ms;
    stage.passes.push(pass);
    stages.set(name, stage);
  }
  return [...stages.values()];
}
