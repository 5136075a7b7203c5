// Tells a page that embeds this one how far it is. The messages say nothing that is not visible.

import type { Viewer } from "../session/viewer.ts";

export function reportToEmbeddingPage(viewer: Viewer): void {
  if (window.parent === window) return;
  const tell = (heliograph: string): void => window.parent.postMessage({ heliograph }, "*");
  let shown = false;
  viewer.connection.state.watch(({ kind }) => {
    if (kind === "live" || kind === "connecting") tell("connected");
  });
  viewer.frame.watch((frame) => {
    if (shown || !frame) return;
    shown = true;
    tell("ready");
  });
}
