// The passes of a frame gathered into its stages: the first part of a pass's name.

import type { FrameStats, PassTiming } from "heliograph/messages.ts";

export interface Stage {
  name: string;
  ms: number;
  passes: PassTiming[];
}

/** In the order of the frame; the encoder, which works beside the frame, comes last. */
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
