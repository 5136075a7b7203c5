// A discreet figure while a static view is refined: "24 of 64 samples", and where the path traced
// reference follows, "3 of 512 path traced samples".

import type { Viewer } from "../session/viewer.ts";
import { element, setText } from "../widgets/element.ts";

const maxSamples = "accumulation.max_samples";
const pathTracedSamples = "reference.samples";

/** Whether the path traced reference follows when the view has all other samples. */
function referenceFollows({ settings }: Viewer): boolean {
  const use = settings.value("reference.use");
  return use === "when_static" || (use === "automatic" && settings.value("indirect.enabled") === true);
}

export function mountRefining(viewer: Viewer, root: HTMLElement): void {
  const text = element("span");
  const bar = element("span", { class: "refining-bar" });
  root.append(text, bar);
  const update = (): void => {
    const { value: frame } = viewer.frame;
    const { value: stats } = viewer.stats;
    let most = Number(viewer.settings.value(maxSamples) ?? 0);
    let samples = Math.max(frame?.samples ?? 0, stats?.samples ?? 0);
    const pathTraced = samples >= most && referenceFollows(viewer);
    if (pathTraced) {
      samples -= most;
      most = Number(viewer.settings.value(pathTracedSamples) ?? 0);
    }
    const refines = stats?.state === "refining" && !frame?.final && samples < most;
    root.hidden = !refines || viewer.connection.state.value.kind !== "live";
    if (root.hidden) return;
    setText(text, `${samples} of ${most} ${pathTraced ? "path traced samples" : "samples"}`);
    bar.style.setProperty("--done", `${(100 * samples) / most}%`);
  };
  viewer.frame.watch(update);
  viewer.stats.watch(update);
  viewer.connection.state.watch(update);
}
