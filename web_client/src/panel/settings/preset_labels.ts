/** Labels of the known presets. Any other preset is shown by its name. */
const presetLabels: Record<string, string> = {
  svgf: "SVGF",
  rectification: "+ Rectification",
  adapted: "+ Adapted blur",
  separable: "+ Separable",
  reinhard: "+ Reinhard",
  best: "Best",
};

export const presetLabel = (name: string): string => presetLabels[name] ?? name;
