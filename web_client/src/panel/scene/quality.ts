// Three choices of quality, from the first look to the last image: groups of settings.

import type { SettingsPreset } from "./preset_chips.ts";

/** All levels name the same settings, so that none depends on the one before. */
export const qualityLevels: SettingsPreset[] = [
  {
    name: "draft",
    label: "Draft",
    description: "Answers fast: no indirect light, few samples, coarse while it moves.",
    settings: {
      accumulation: { max_samples: 8 },
      indirect: { enabled: false, half_resolution: null },
      motion: { scale: 0.25, frame_time: 33 },
    },
  },
  {
    name: "balanced",
    label: "Balanced",
    description: "The server's own settings.",
    settings: {
      accumulation: { max_samples: null },
      indirect: { enabled: null, half_resolution: null },
      motion: { scale: null, frame_time: null },
    },
  },
  {
    name: "best",
    label: "Best",
    description: "For images to keep: many samples, indirect light at full size.",
    settings: {
      accumulation: { max_samples: 1024 },
      indirect: { enabled: true, half_resolution: false },
      motion: { scale: 0.75, frame_time: null },
    },
  },
];
