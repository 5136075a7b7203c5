// What is shown and in which light.

import type { SceneInfo } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import { createCameraFields } from "./camera_fields.ts";
import { requiresControl } from "../../widgets/requires_control.ts";
import { element, icon, setText } from "../../widgets/element.ts";
import { createEnvironmentField } from "./environment_field.ts";
import { createLightSection } from "./light_section.ts";
import { createMaterialSection } from "./material_section.ts";
import { createPartFields } from "./part_fields.ts";
import { createScenePicker } from "./scene_picker.ts";
import { mountSettings } from "../settings/settings_sections.ts";

/** Settings of the scene's look, which stand here instead of among the renderer's. */
export const appearanceGroups = ["exposure", "tone_map", "environment"];

export function createSceneTab(viewer: Viewer, bring: (file: File) => void): HTMLElement {
  const facts = element("p", { class: "facts" });
  const warnings = element("details", { class: "warnings", hidden: true });
  viewer.scene.watch((scene) => {
    setText(facts, scene ? describeScene(scene) : "");
    showWarnings(warnings, scene?.warnings ?? []);
  });
  const look = element("div", { class: "settings" });
  mountSettings(look, viewer.settings, { id: "look", only: appearanceGroups });
  return requiresControl(
    viewer,
    element(
      "div",
      { class: "fields", "data-section": "scene" },
      ...createScenePicker(viewer, bring),
      facts,
      warnings,
      ...createPartFields(viewer),
      ...createCameraFields(viewer),
      createEnvironmentField(viewer.parts),
    ),
    createLightSection(viewer.parts),
    look,
    createMaterialSection(viewer.parts).node,
  );
}

function describeScene(scene: SceneInfo): string {
  const count = (value: number, one: string): string =>
    value > 0 ? `${compact(value)} ${one}${value === 1 ? "" : "s"}` : "";
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
