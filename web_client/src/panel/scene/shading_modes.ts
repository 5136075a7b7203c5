// Ways to show surfaces: as they are lit, or what the model is made of.

import type { SettingsPreset } from "./preset_chips.ts";

const mode = (name: string, label: string, description: string): SettingsPreset => ({
  name,
  label,
  description,
  settings: { view: { shading: name } },
});

export const shadingModes: SettingsPreset[] = [
  mode("lit", "Lit", "Surfaces as they are."),
  mode("wireframe", "Wireframe", "Lit, with the edges of triangles."),
  mode("clay", "Clay", "Lit, all of one grey material."),
  mode("matcap", "Matcap", "The shape alone, without light or shadows."),
  mode("uv_checker", "UV", "A checkerboard by texture coordinates."),
  mode("normals", "Normals", "The directions that surfaces face: x red, y green, z blue."),
];
