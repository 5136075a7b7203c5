// Edits one material of the scene, and sweeps its roughness.

import type { MaterialInfo, MaterialPatch } from "heliograph/messages.ts";
import { displayColour, linearColour } from "../../common/colour.ts";
import { preferences } from "../../common/preferences.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, icon, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createSection } from "../../widgets/section.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";
import { createMaterialRows } from "./material_rows.ts";
import { createTextureRows } from "./texture_rows.ts";

const sweepMs = 6000;
const sweepStepMs = 100;

interface MaterialSection {
  node: HTMLElement;
  /** Shows the material of this name. */
  choose(name: string): void;
}

export function createMaterialSection(
  viewer: Viewer,
  upload: (file: File) => Promise<string | null>,
): MaterialSection {
  const { parts } = viewer;
  const select = element("select", { name: "material", change: () => show() });
  const selected = (): MaterialInfo | undefined =>
    parts.materials.value.find(({ name }) => name === select.value) ?? parts.materials.value[0];
  const patch = (change: MaterialPatch): void => {
    const material = selected();
    if (material) parts.patchMaterial(material.name, change as Partial<MaterialInfo>);
  };
  const fraction = (label: string, description: string, report: (value: number) => void) =>
    createSliderRow(
      { label, description, unit: "", minimum: 0, maximum: 1, scale: "linear" },
      report,
    );
  const roughness = fraction(
    "Roughness",
    "From a perfect mirror (0) to a matt surface (1). A factor on the texture, if there is one.",
    (value) => patch({ roughness: value }),
  );
  const metallic = fraction(
    "Metallic",
    "Metal (1) or dielectric (0). A factor on the texture, if there is one.",
    (value) => patch({ metallic: value }),
  );
  const colour = element("input", {
    type: "color",
    name: "base_color",
    "aria-label": "Base colour",
    input: () => patch({ base_color: linearColour(colour.value) }),
  });
  const reset = button("Reset this material", "reset", () => {
    const material = selected();
    if (material) parts.resetMaterial(material.name);
  });
  const sweep = createSweep(
    (value) => patch({ roughness: value }),
    () => selected()?.roughness,
  );
  const rows = createMaterialRows(patch);
  const textures = createTextureRows(viewer, upload);
  const textureFold = createFold("material_textures", "Textures", [textures.node]);
  viewer.textures.list.watch((list) => (textureFold.hidden = list === null));
  const body = element(
    "div",
    { class: "section-body" },
    field("Material", select, reset),
    field("Base colour", colour),
    roughness.node,
    metallic.node,
    sweep,
    createFold("material_factors", "Emission, coat, sheen and glass", rows.nodes),
    textureFold,
  );
  const show = (): void => {
    const material = selected();
    if (!material) return;
    select.value = material.name;
    roughness.show(material.roughness);
    metallic.show(material.metallic);
    colour.value = displayColour(material.base_color);
    rows.show(material);
    textures.show(material.name);
  };
  const node = createSection({ id: "materials", title: "Materials", body, openByDefault: false });
  parts.materials.watch((materials) => {
    node.hidden = materials.length === 0;
    setOptions(
      select,
      materials.map(({ name }) => ({ value: name, label: name })),
    );
    show();
  });
  const choose = (name: string): void => {
    select.value = name;
    show();
  };
  return { node, choose };
}

function createFold(id: string, title: string, nodes: HTMLElement[]): HTMLElement {
  const key = `open.${id}`;
  const fold = element(
    "details",
    {
      class: "inner-fold",
      open: preferences.flag(key, false),
      toggle: () => preferences.setFlag(key, fold.open),
    },
    element("summary", {}, icon("chevron"), element("h3", {}, title)),
    ...nodes,
  );
  return fold;
}

/** Animates the roughness from 0 to 1, then restores it. */
function createSweep(
  set: (roughness: number) => void,
  get: () => number | undefined,
): HTMLButtonElement {
  let timer = 0;
  let before: number | undefined;
  const stop = (): void => {
    clearInterval(timer);
    timer = 0;
    sweep.textContent = "Sweep the roughness";
    if (before !== undefined) set(before);
  };
  const sweep = element(
    "button",
    {
      type: "button",
      class: "button quiet",
      click: () => {
        if (timer) {
          stop();
          return;
        }
        before = get();
        const startedAt = performance.now();
        sweep.textContent = "Stop the sweep";
        timer = window.setInterval(() => {
          const fraction = (performance.now() - startedAt) / sweepMs;
          if (fraction >= 1) stop();
          else set(Math.round(fraction * 100) / 100);
        }, sweepStepMs);
      },
    },
    "Sweep the roughness",
  );
  return sweep;
}
