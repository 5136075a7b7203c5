// The camera's path through the bookmarks: play it here, or render it as a video.

import { Signal } from "../../common/signal.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { Path, PathPlayer } from "../../view/path_player.ts";
import { element, setText } from "../../widgets/element.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";

const leastKeys = 2;

/** What the path through the bookmarks is like, for this page. */
export interface PathOptions {
  seconds: Signal<number>;
  closed: Signal<boolean>;
}

export function createPathOptions(): PathOptions {
  return { seconds: new Signal(6), closed: new Signal(false) };
}

/** The path through the bookmarks of the scene; null where there are too few. */
export function bookmarkPath(viewer: Viewer, options: PathOptions): Path | null {
  const bookmarks = viewer.scene.value ? viewer.bookmarks.list.value : [];
  if (bookmarks.length < leastKeys) return null;
  const keys = bookmarks.map(({ eye, target, up, vertical_fov }) => ({
    eye,
    target,
    up,
    vertical_fov,
    name: null,
  }));
  const form = { smooth: true, closed: options.closed.value };
  return { keys, form, seconds: options.seconds.value };
}

export function createPathFields(
  viewer: Viewer,
  player: PathPlayer,
  options: PathOptions,
): HTMLElement {
  const toggle = (): void => {
    const path = bookmarkPath(viewer, options);
    if (player.running.value || !path) player.stop();
    else player.play(path);
  };
  const play = element("button", { type: "button", class: "button quiet", click: toggle });
  const loop = element(
    "button",
    {
      type: "button",
      class: "button quiet",
      "data-tip": "From the last bookmark back to the first, again and again",
      click: () => options.closed.set(!options.closed.value),
    },
    "Loop",
  );
  const seconds = createSliderRow(
    {
      label: "Duration",
      description: "Time from the first bookmark to the last.",
      unit: "seconds",
      minimum: 1,
      maximum: 60,
      scale: "linear",
    },
    (value) => options.seconds.set(value),
  );
  const node = element(
    "div",
    { class: "camera-path", role: "group", "aria-label": "Path through the bookmarks" },
    element("div", { class: "tool-buttons" }, play, loop),
    seconds.node,
  );
  const update = (): void => {
    node.hidden = bookmarkPath(viewer, options) === null;
    if (node.hidden) player.stop();
  };
  viewer.bookmarks.list.watch(update);
  viewer.scene.watch(update);
  options.seconds.watch((value) => seconds.show(value));
  options.closed.watch((closed) => loop.setAttribute("aria-pressed", String(closed)));
  player.running.watch((running) => {
    setText(play, running ? "Stop" : "Play path");
    play.setAttribute("aria-pressed", String(running));
  });
  return node;
}
