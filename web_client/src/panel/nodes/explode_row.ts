// How far the parts of the model are apart.

import type { Viewer } from "../../session/viewer.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";

const explodeSetting = "view.explode";
const mostByHand = 3;

export function createExplodeRow(viewer: Viewer): HTMLElement {
  const { settings } = viewer;
  const row = createSliderRow(
    {
      label: "Exploded view",
      description: "Moves parts away from the middle of the object that they belong to.",
      unit: "",
      minimum: 0,
      maximum: mostByHand,
      scale: "linear",
    },
    (value) => settings.change(explodeSetting, value),
  );
  settings.tree.watch(() => {
    const value = settings.value(explodeSetting);
    row.node.hidden = value === undefined;
    row.show(Number(value ?? 0));
  });
  return row.node;
}
