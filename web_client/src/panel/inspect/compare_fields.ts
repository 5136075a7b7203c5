// Selects what to compare with and shows the similarity.

import type { Comparison } from "../../compare/comparison.ts";
import { maxSamplesSetting } from "../../compare/compared_session.ts";
import { type Counterpart, describeComparison } from "../../compare/comparison_state.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { CompareMode, Divider } from "../../view/divider.ts";
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
    element("option", { value: "wipe" }, "Wipe"),
    element("option", { value: "side" }, "Side by side"),
    element("option", { value: "difference" }, "Difference"),
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
  let gain = 8;
  const gainRow = createSliderRow(
    {
      label: "Amplification",
      description: "Factor on the difference of the two frames.",
      unit: "",
      minimum: 1,
      maximum: 64,
      scale: "logarithmic",
    },
    (value) => {
      gain = value;
      updateLayout();
    },
  );
  const facts = element("p", { class: "facts", role: "status", "data-figure-of": "similarity" });
  const updateLayout = (): void => {
    const layout = select.value === none ? null : mode.value;
    opacityRow.node.hidden = layout !== "overlay";
    opacityRow.show(opacity);
    gainRow.node.hidden = layout !== "difference";
    gainRow.show(gain);
    divider.setMode(mode.value as CompareMode, { opacity, gain });
  };
  const choose = (): void => {
    const counterpart = parsed(select.value);
    if (!counterpart) {
      comparison.stop();
      return;
    }
    if (counterpart.kind === "buffer" && overlaidBuffers.test(counterpart.name))
      mode.value = "overlay";
    if (counterpart.kind !== "buffer" && mode.value === "overlay") mode.value = "wipe";
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
      updateLayout();
      setText(facts, "");
      return;
    }
    const most = Number(viewer.settings.value(maxSamplesSetting) ?? 1);
    setText(facts, describeComparison(state, most));
  });
  const node = element(
    "div",
    { class: "fields", "data-section": "compare" },
    field("Compare", select),
    field("Layout", mode),
    opacityRow.node,
    gainRow.node,
    facts,
  );
  mode.closest<HTMLElement>(".field")?.setAttribute("hidden", "");
  updateLayout();
  const updateVisibility = (): void => {
    node.hidden = !comparison.possible;
  };
  viewer.capabilities.methods.watch(updateVisibility);
  viewer.membership.controlState.watch(updateVisibility);
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
