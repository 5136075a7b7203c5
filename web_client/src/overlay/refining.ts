// A discreet figure while a static view is refined: "24 of 64 samples", and where the path traced
// reference follows, "3 of 512 path traced samples".

import { refinementOf, refinementText } from "../session/refinement.ts";
import type { Viewer } from "../session/viewer.ts";
import { element, setText } from "../widgets/element.ts";

export function mountRefining(viewer: Viewer, root: HTMLElement): void {
  const text = element("span");
  const bar = element("span", { class: "refining-bar" });
  root.append(text, bar);
  const update = (): void => {
    const { value: frame } = viewer.frame;
    const { value: stats } = viewer.stats;
    const count = Math.max(frame?.samples ?? 0, stats?.samples ?? 0);
    const refinement = refinementOf(count, viewer.settings);
    const { samples, of } = refinement;
    const refines = stats?.state === "refining" && !frame?.final && samples < of;
    root.hidden = !refines || viewer.connection.state.value.kind !== "live";
    if (root.hidden) return;
    setText(text, refinementText(refinement));
    bar.style.setProperty("--done", `${(100 * samples) / of}%`);
  };
  viewer.frame.watch(update);
  viewer.stats.watch(update);
  viewer.connection.state.watch(update);
}
