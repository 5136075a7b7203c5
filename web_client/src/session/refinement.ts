// How far a static view is refined: samples of the hybrid, then those of the path traced reference.

import type { SettingsStore } from "./settings_store.ts";

const maxSamples = "accumulation.max_samples";
const pathTracedSamples = "reference.samples";

type Values = Pick<SettingsStore, "value">;

interface Refinement {
  samples: number;
  /** How many there will be. */
  of: number;
  pathTraced: boolean;
}

/** Whether the path traced reference follows when the view has all other samples. */
export function referenceFollows(settings: Values): boolean {
  const use = settings.value("reference.use");
  const automatic = use === "automatic" && settings.value("indirect.enabled") === true;
  return use === "when_static" || automatic;
}

/** Of a frame with so many samples, as its header counts them. */
export function refinementOf(samples: number, settings: Values): Refinement {
  const most = Number(settings.value(maxSamples) ?? 1);
  if (!referenceFollows(settings) || samples < most) return { samples, of: most, pathTraced: false };
  const of = Number(settings.value(pathTracedSamples) ?? 0);
  return { samples: samples - most, of, pathTraced: true };
}

/** "1 sample", "12 path traced samples". */
function countedSamples(samples: number, pathTraced = false): string {
  return `${samples} ${pathTraced ? "path traced " : ""}${samples === 1 ? "sample" : "samples"}`;
}

/** "24 of 64 samples", "3 of 512 path traced samples". */
export function refinementText({ samples, of, pathTraced }: Refinement): string {
  return `${samples} of ${countedSamples(Math.max(of, samples), pathTraced)}`;
}

/** What a frame with so many samples shows: those of the reference, once it has some. */
export function shownSamples(samples: number, settings: Values): string {
  const now = refinementOf(samples, settings);
  return now.pathTraced && now.samples > 0
    ? countedSamples(now.samples, true)
    : countedSamples(samples);
}
