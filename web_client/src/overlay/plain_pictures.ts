// Where no WebSocket gets through, the pictures come as motion JPEG: to be seen, not to be steered.

import type { Viewer } from "../viewer.ts";

export function mountPlainPictures(viewer: Viewer, image: HTMLImageElement): void {
  const session = new URL(document.baseURI).searchParams.get("session") ?? "main";
  const source = new URL(`api/v1/sessions/${session}/stream.mjpg`, document.baseURI).href;
  image.addEventListener("error", () => (image.hidden = true));
  viewer.connection.state.watch(({ kind }) => {
    if (kind === "pictures_only") {
      if (image.src !== source) image.src = source;
      image.hidden = false;
    } else if (kind === "live" && image.hasAttribute("src")) {
      image.removeAttribute("src");
      image.hidden = true;
    }
  });
}
