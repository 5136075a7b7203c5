// A discreet figure while a static view is refined: "24 of 1024 samples".

import type { Viewer } from "../session/viewer.ts";
import { element, setText } from "../widgets/element.ts";

const maxSamples = "accumulation.max_samples";

export function mountRefining(viewer: Viewer, root: HTMLElement): void {
  const text = element("span");
  const bar = element("span", { class: "refining-bar" });
  root.append(text, bar);
  const update = (): void => {
    const { value: frame } = viewer.frame;
    const { value: stats } = viewer.stats;
    const most = Number(viewer.settings.value(maxSamples) ?? 0);
    const samples = Math.max(frame?.samples ?? 0, stats?.samples ?? 0);
    const refines = stats?.state === "refining" && !frame?.final && samples < most;
    root.hidden = !refines || viewer.connection.state.value.kind !== "live";
    if (root.hidden) return;
    setText(text, `${samples} of ${most} samples`);
    bar.style.setProperty("--done", `${(100 * samples) / most}%`);
  };
  viewer.frame.watch(update);
  viewer.stats.watch(update);
  viewer.connection.state.watch(update);
}
