// Selects what to compare with and shows the similarity.

import type { Comparison } from "../../compare/comparison.ts";
import type { Counterpart } from "../../compare/comparison_state.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { Divider } from "../../view/divider.ts";
import { element, setOptions, setText } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";
import { presetLabel } from "../../common/labels.ts";
import { bufferLabel } from "./buffer_fields.ts";

const none = "";
/** Buffers that are shown over the frame instead of beside it. */
const overlaidBuffers = /history|disoccluded/;

export function createCompareFields(
  viewer: Viewer,
  comparison: Comparison,
  divider: Divider,
): HTMLElement {
  const select = element("select", { name: "compare", change: () => choose() });
  const mode = element(
    "select",
    { name: "compare_mode", change: () => updateLayout() },
    element("option", { value: "split" }, "Side by side"),
    element("option", { value: "overlay" }, "Overlay"),
  );
  let opacity = 0.6;
  const opacityRow = createSliderRow(
    {
      label: "Opacity",
      description: "Opacity of the upper frame.",
      unit: "",
      minimum: 0,
      maximum: 1,
      scale: "linear",
    },
    (value) => {
      opacity = value;
      updateLayout();
    },
  );
  const facts = element("p", { class: "facts", role: "status", "data-figure-of": "similarity" });
  const updateLayout = (): void => {
    const split = mode.value === "split";
    opacityRow.node.hidden = split || select.value === none;
    opacityRow.show(opacity);
    divider.setMode(split ? "split" : "overlay", opacity);
  };
  const choose = (): void => {
    const counterpart = parsed(select.value);
    if (!counterpart) {
      comparison.stop();
      return;
    }
    if (counterpart.kind === "buffer" && overlaidBuffers.test(counterpart.name))
      mode.value = "overlay";
    if (counterpart.kind !== "buffer") mode.value = "split";
    updateLayout();
    void comparison.start(counterpart);
  };
  const fill = (): void => {
    setOptions(select, [
      { value: none, label: "Nothing" },
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
    select.value = state ? valueOf(state.counterpart) : none;
    const label = state ? (select.selectedOptions[0]?.textContent ?? "") : "";
    divider.show(state !== null, label);
    mode.closest<HTMLElement>(".field")?.toggleAttribute("hidden", state === null);
    if (!state) {
      opacityRow.node.hidden = true;
      setText(facts, "");
      return;
    }
    const similarity = state.similarity === null ? "…" : state.similarity.toFixed(4);
    const count = state.frame?.samples ?? 0;
    const samples = count === 1 ? " · 1 sample" : ` · ${count} samples`;
    if (state.counterpart.kind === "buffer") setText(facts, "");
    else if (!state.frame) setText(facts, "Starting the second session");
    else setText(facts, `SSIM ${similarity}${samples}`);
  });
  const node = element(
    "div",
    { class: "fields", "data-section": "compare" },
    field("Compare", select),
    field("Layout", mode),
    opacityRow.node,
    facts,
  );
  mode.closest<HTMLElement>(".field")?.setAttribute("hidden", "");
  opacityRow.node.hidden = true;
  const updateVisibility = (): void => {
    node.hidden = !comparison.possible;
  };
  viewer.capabilities.methods.watch(updateVisibility);
  viewer.controlState.watch(updateVisibility);
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
