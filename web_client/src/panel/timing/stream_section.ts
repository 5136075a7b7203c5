// Resolution, quality and codec of the stream.

import type { StreamSettings } from "heliograph/messages.ts";
import { preferences } from "../../common/preferences.ts";
import { Signal } from "../../common/signal.ts";
import type { Viewer } from "../../session/viewer.ts";
import { element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

export interface ResolutionChoice {
  /** Fraction of the screen's device pixels in each direction. */
  scale: number;
  /** Whether the resolution is lower for servers that render on a CPU. */
  automatic: boolean;
}

const resolutions: Record<string, { label: string; choice: ResolutionChoice }> = {
  auto: { label: "Automatic", choice: { scale: 1, automatic: true } },
  full: { label: "Full", choice: { scale: 1, automatic: false } },
  three_quarters: { label: "Three quarters", choice: { scale: 0.75, automatic: false } },
  half: { label: "Half", choice: { scale: 0.5, automatic: false } },
  third: { label: "A third", choice: { scale: 1 / 3, automatic: false } },
};

const codecLabels: Record<string, string> = { jpeg: "JPEG", h264: "H.264", av1: "AV1" };

const qualities: [value: number, label: string][] = [
  [60, "Low"],
  [80, "Good"],
  [92, "High"],
  [98, "Best"],
];

export function createStreamSection(viewer: Viewer): {
  node: HTMLElement;
  resolution: Signal<ResolutionChoice>;
} {
  const automatic = resolutions.auto!.choice;
  const stored = resolutions[preferences.text("resolution", "auto")];
  const resolution = new Signal(stored?.choice ?? automatic);
  const sizes = element(
    "select",
    {
      name: "resolution",
      "data-tip": "Fewer pixels render faster. Automatic: fewer pixels where a CPU renders.",
      change: () => {
        preferences.setText("resolution", sizes.value);
        resolution.set(resolutions[sizes.value]?.choice ?? automatic);
      },
    },
    ...Object.entries(resolutions).map(([value, { label }]) => element("option", { value }, label)),
  );
  sizes.value = stored ? preferences.text("resolution", "auto") : "auto";
  const node = element(
    "div",
    { class: "fields", "data-section": "stream" },
    field("Resolution", sizes),
    field("Quality", qualityPicker(viewer)),
    codecField(viewer),
    field("Smooth motion", reprojectionSwitch(viewer)),
  );
  return { node, resolution };
}

function qualityPicker(viewer: Viewer): HTMLSelectElement {
  const select = element(
    "select",
    {
      name: "quality",
      "data-tip": "JPEG quality of the stream. Saved images are always lossless.",
      change: () => {
        preferences.setText("quality", select.value);
        viewer.stream.request({ quality: Number(select.value) });
      },
    },
    ...qualities.map(([value, label]) => element("option", { value: String(value) }, label)),
  );
  const stored = Number(preferences.text("quality", ""));
  if (qualities.some(([value]) => value === stored)) viewer.stream.request({ quality: stored });
  viewer.stream.settings.watch((stream) => {
    if (!stream) return;
    const distance = (value: number): number => Math.abs(value - stream.quality);
    const nearest = [...qualities].sort((a, b) => distance(a[0]) - distance(b[0]))[0];
    if (nearest) select.value = String(nearest[0]);
  });
  return select;
}

function reprojectionSwitch(viewer: Viewer): HTMLInputElement {
  const box = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "reprojection",
    "data-tip": "Between frames of the server, the last one is shown from the new camera.",
    change: () => {
      preferences.setFlag("reprojection", box.checked);
      viewer.stream.request({ depth: box.checked });
    },
  });
  if (!preferences.flag("reprojection", true)) viewer.stream.request({ depth: false });
  viewer.stream.settings.watch((stream) => {
    if (stream) box.checked = stream.depth;
  });
  return box;
}

/** Hidden where server and browser have only one codec in common. */
function codecField(viewer: Viewer): HTMLElement {
  const select = element("select", {
    name: "codec",
    "data-tip": "H.264 needs a fraction of the bandwidth, JPEG is sharper during motion.",
    change: () => {
      preferences.setText("codec", select.value);
      viewer.stream.request({ codec: select.value as StreamSettings["codec"] });
    },
  });
  const node = field("Codec", select);
  viewer.connection.state.watch((state) => {
    if (state.kind !== "live") return;
    const { codecs } = state.hello;
    node.hidden = codecs.length < 2;
    setOptions(
      select,
      codecs.map((name) => ({ value: name, label: codecLabels[name] ?? name })),
    );
    select.value = viewer.stream.settings.value?.codec ?? codecs[0] ?? "jpeg";
  });
  viewer.stream.settings.watch((stream) => {
    if (stream?.codec) select.value = stream.codec;
  });
  return node;
}
