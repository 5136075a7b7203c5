// Selects one of the scenes and material variants of a file; hidden for files with one scene.

import type { Viewer } from "../../session/viewer.ts";
import { element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

const fileDefault = "";

export function createPartFields(viewer: Viewer): HTMLElement[] {
  const load = (): void => {
    const current = viewer.scene.value;
    if (!current) return;
    void viewer.loading.load(current.name, {
      scene: parts.value || undefined,
      variant: variants.value || undefined,
    });
  };
  const parts = element("select", { name: "part", change: load });
  const variants = element("select", { name: "variant", change: load });
  const partField = field("Scene in file", parts);
  const variantField = field("Variant", variants);
  viewer.scene.watch((scene) => {
    const names = scene?.scenes ?? [];
    partField.hidden = names.length < 2;
    setOptions(
      parts,
      names.map((name, number) => ({
        value: String(number),
        label: name || `Scene ${number + 1}`,
      })),
    );
    parts.value = String(scene?.scene ?? 0);
    variantField.hidden = !scene || scene.variants.length === 0;
    setOptions(variants, [
      { value: fileDefault, label: "None" },
      ...(scene?.variants ?? []).map((name) => ({ value: name, label: name })),
    ]);
    variants.value = scene?.variant ?? fileDefault;
  });
  return [partField, variantField];
}
