// What to compare with, and how alike the two are.

import type { Comparison } from "../../compare/comparison.ts";
import type { Counterpart } from "../../compare/comparison_state.ts";
import type { Divider } from "../../view/divider.ts";
import type { Viewer } from "../../session/viewer.ts";
import { bufferLabel } from "./buffer_fields.ts";
import { element, setOptions, setText } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { presetLabel } from "../settings/preset_labels.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";

const nothing = "";
const overlaid = /history|disocclusion/;

export function createCompareFields(
  viewer: Viewer,
  comparison: Comparison,
  divider: Divider,
): HTMLElement {
  const select = element("select", { name: "compare", change: () => choose() });
  const way = element(
    "select",
    { name: "compare_way", change: () => arrange() },
    element("option", { value: "split" }, "Side by side"),
    element("option", { value: "overlay" }, "One over the other"),
  );
  let opacity = 0.6;
  const opacityRow = createSliderRow(
    {
      label: "Opacity",
      description: "How much the picture on top covers.",
      unit: "",
      minimum: 0,
      maximum: 1,
      scale: "linear",
    },
    (value) => {
      opacity = value;
      arrange();
    },
  );
  const facts = element("p", { class: "facts", role: "status", "data-figure-of": "similarity" });
  const arrange = (): void => {
    const split = way.value === "split";
    opacityRow.node.hidden = split || select.value === nothing;
    opacityRow.show(opacity);
    divider.arrange(split ? "split" : "overlay", opacity);
  };
  const choose = (): void => {
    const counterpart = parsed(select.value);
    if (!counterpart) {
      comparison.stop();
      return;
    }
    if (counterpart.kind === "buffer" && overlaid.test(counterpart.name)) way.value = "overlay";
    if (counterpart.kind !== "buffer") way.value = "split";
    arrange();
    void comparison.start(counterpart);
  };
  const fill = (): void => {
    setOptions(select, [
      { value: nothing, label: "Nothing" },
      { value: "reference", label: "Path traced reference" },
      ...viewer.capabilities.presets.value.map(({ name }) => ({
        value: `preset:${name}`,
        label: `Preset ${presetLabel(name)}`,
      })),
      ...viewer.capabilities.buffers.value
        .filter(({ name }) => name !== "output")
        .map(({ name }) => ({ value: `buffer:${name}`, label: `Buffer ${bufferLabel(name)}` })),
    ]);
  };
  viewer.capabilities.presets.watch(fill);
  viewer.capabilities.buffers.watch(fill);
  comparison.state.watch((state) => {
    select.value = state ? valueOf(state.counterpart) : nothing;
    const label = state ? (select.selectedOptions[0]?.textContent ?? "") : "";
    divider.show(state !== null, label);
    way.closest<HTMLElement>(".field")?.toggleAttribute("hidden", state === null);
    if (!state) {
      opacityRow.node.hidden = true;
      setText(facts, "");
      return;
    }
    const alike = state.similarity === null ? "…" : state.similarity.toFixed(4);
    const count = state.frame?.samples ?? 0;
    const samples = count === 1 ? " · 1 sample" : ` · ${count} samples`;
    if (state.counterpart.kind === "buffer") setText(facts, "");
    else if (!state.frame) setText(facts, "The second session starts");
    else setText(facts, `SSIM ${alike}${samples}`);
  });
  const node = element(
    "div",
    { class: "fields", "data-section": "compare" },
    field("Compare", select),
    field("As", way),
    opacityRow.node,
    facts,
  );
  way.closest<HTMLElement>(".field")?.setAttribute("hidden", "");
  opacityRow.node.hidden = true;
  const offer = (): void => {
    node.hidden = !comparison.possible;
  };
  viewer.capabilities.methods.watch(offer);
  viewer.controlState.watch(offer);
  return node;
}

function valueOf(counterpart: Counterpart): string {
  return counterpart.kind === "reference" ? "reference" : `${counterpart.kind}:${counterpart.name}`;
}

function parsed(value: string): Counterpart | null {
  if (value === "reference") return { kind: "reference" };
  const [kind, name] = [value.slice(0, value.indexOf(":")), value.slice(value.indexOf(":") + 1)];
  return kind === "preset" || kind === "buffer" ? { kind, name } : null;
}
