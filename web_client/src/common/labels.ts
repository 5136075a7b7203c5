// Labels of known presets and settings in plain words. All others are shown by their names.

import type { ControlGroup } from "heliograph/settings_schema.ts";

const presetLabels: Record<string, string> = {
  svgf: "SVGF",
  rectification: "+ Rectification",
  adapted: "+ Adapted blur",
  separable: "+ Separable",
  reinhard: "+ Reinhard",
  best: "Best",
};

const settingLabels: Record<string, string> = {
  "exposure.compensation": "Exposure (EV)",
  "environment.separate_sun": "Sun as a light",
  "background.color": "Colour",
  "background.upper_color": "Upper colour",
};

export const presetLabel = (name: string): string => presetLabels[name] ?? name;

export function withPlainLabels(group: ControlGroup): ControlGroup {
  return {
    ...group,
    controls: group.controls.map((control) => ({
      ...control,
      label: settingLabels[control.path] ?? control.label,
    })),
    groups: group.groups.map(withPlainLabels),
  };
}
