// The Scene tab: scene, camera, environment, lights, materials.

import type { SceneInfo } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { PointPicker } from "../../view/picker.ts";
import { element, icon, setText } from "../../widgets/element.ts";
import { requiresControl } from "../../widgets/requires_control.ts";
import { createNodeSection } from "../nodes/node_section.ts";
import { mountSettings } from "../settings/settings_sections.ts";
import { type CameraTools, createCameraFields } from "./camera_fields.ts";
import { createEditsSection } from "./edits_section.ts";
import { createEnvironmentField } from "./environment_field.ts";
import { createLightSection } from "./light_section.ts";
import { createMaterialSection } from "./material_section.ts";
import { createPartFields } from "./part_fields.ts";
import { createPresetChips } from "./preset_chips.ts";
import { qualityLevels } from "./quality.ts";
import { createScenePicker } from "./scene_picker.ts";
import { createPlanesSection } from "./section_planes.ts";
import { shadingModes } from "./shading_modes.ts";

/** Groups of settings that are shown here instead of in the Settings tab. */
export const appearanceGroups = ["lens", "exposure", "tone_map", "environment", "background"];

interface Uploads {
  upload(this: void, file: File): void;
  uploadImage(this: void, file: File): Promise<string | null>;
}

export function createSceneTab(
  viewer: Viewer,
  picker: PointPicker,
  camera: CameraTools,
  { upload, uploadImage }: Uploads,
): HTMLElement {
  const facts = element("p", { class: "facts" });
  const warnings = element("details", { class: "warnings", hidden: true });
  viewer.scene.watch((scene) => {
    setText(facts, scene ? describeScene(scene) : "");
    showWarnings(warnings, scene?.warnings ?? []);
  });
  const appearance = element("div", { class: "settings" });
  mountSettings(appearance, viewer.settings, { id: "appearance", only: appearanceGroups });
  return requiresControl(
    viewer,
    element(
      "div",
      { class: "fields", "data-section": "scene" },
      createPresetChips(viewer, "Quality", qualityLevels),
      createPresetChips(viewer, "Shading", shadingModes),
      ...createScenePicker(viewer, upload),
      facts,
      warnings,
      ...createPartFields(viewer),
      ...createCameraFields(viewer, camera),
      ...createEnvironmentField(viewer, upload),
    ),
    createNodeSection(viewer, picker),
    createPlanesSection(viewer),
    createLightSection(viewer),
    appearance,
    createMaterialSection(viewer, uploadImage).node,
    createEditsSection(viewer),
  );
}

function describeScene(scene: SceneInfo): string {
  const count = (value: number, noun: string): string =>
    value > 0 ? `${compact(value)} ${noun}${value === 1 ? "" : "s"}` : "";
  return [
    count(scene.triangles, "triangle"),
    count(scene.materials, "material"),
    count(scene.textures, "texture"),
    count(scene.lights, "light"),
  ]
    .filter(Boolean)
    .join(" · ");
}

function compact(value: number): string {
  if (value >= 1e6) return `${(value / 1e6).toFixed(1)} M`;
  return value >= 10_000 ? `${Math.round(value / 1000)} k` : String(value);
}

function showWarnings(node: HTMLDetailsElement, warnings: string[]): void {
  node.hidden = warnings.length === 0;
  const noun = warnings.length === 1 ? "warning" : "warnings";
  node.replaceChildren(
    element("summary", {}, icon("warning"), `${warnings.length} ${noun} in this file`),
    element("ul", {}, ...warnings.map((text) => element("li", {}, text))),
  );
}
