// The bookmarks of the scene: a thumbnail and a name each, which can be changed.

import type { Bookmark } from "heliograph/messages.ts";
import { cropped } from "../../common/image_files.ts";
import { maxNameLength } from "../../session/bookmarks.ts";
import { describeControl } from "../../session/control_state.ts";
import type { Viewer } from "../../session/viewer.ts";
import { confirmButton } from "../../widgets/confirm_button.ts";
import { button, element } from "../../widgets/element.ts";

const thumbnailWidth = 112;

export function createBookmarkList(viewer: Viewer): { node: HTMLElement; add: () => void } {
  const list = element("ul", { class: "bookmarks", "aria-label": "Bookmarks" });
  const show = (): void => {
    const bookmarks = viewer.scene.value ? viewer.bookmarks.list.value : [];
    list.hidden = bookmarks.length === 0;
    list.replaceChildren(...bookmarks.map((bookmark) => createEntry(viewer, bookmark, show)));
  };
  const add = async (): Promise<void> => {
    const camera = viewer.camera.value;
    if (!viewer.scene.value || !camera) return;
    if (!viewer.mayChange) {
      viewer.onInfo(describeControl(viewer.membership.controlState.value), "bookmark");
      return;
    }
    const frame = await viewer.connection.copyFrame();
    const thumbnail = frame ? (cropped(frame, thumbnailWidth) ?? undefined) : undefined;
    frame?.close();
    const name = await viewer.bookmarks.add(camera, thumbnail);
    if (name !== null) viewer.onInfo(`Bookmarked as ${name}`, "bookmark");
  };
  viewer.scene.watch(show);
  viewer.bookmarks.list.watch(show);
  viewer.membership.controlState.watch(show);
  return { node: list, add: () => void add() };
}

/** `reset` shows the bookmarks again as they are. */
function createEntry(viewer: Viewer, bookmark: Bookmark, reset: () => void): HTMLElement {
  const { name, thumbnail, eye, target, up, vertical_fov } = bookmark;
  const camera = { eye, target, up, vertical_fov, name: null };
  const image = element("img", { alt: "", class: "bookmark-image" });
  if (thumbnail) image.src = thumbnail;
  const choose = element(
    "button",
    { type: "button", class: "bookmark", click: () => viewer.cameraMoves.animateTo(camera) },
    thumbnail ? image : null,
    element("span", {}, name),
  );
  if (!viewer.mayChange) return element("li", {}, choose);
  const rename = button(`Rename ${name}`, "pencil", () => {
    choose.replaceWith(entry);
    entry.focus();
    entry.select();
  });
  let cancelled = false;
  const entry = element("input", {
    type: "text",
    class: "bookmark-name",
    "aria-label": `New name of ${name}`,
    maxlength: String(maxNameLength),
    keydown: (event: KeyboardEvent) => {
      event.stopPropagation();
      cancelled = event.key === "Escape";
      if (event.key === "Enter" || event.key === "Escape") entry.blur();
    },
    blur: () => {
      const renamed = cancelled ? null : viewer.bookmarks.rename(name, entry.value);
      void Promise.resolve(renamed).then(reset);
    },
  });
  entry.value = name;
  const remove = confirmButton(`Remove ${name}`, "close", () => {
    void viewer.bookmarks.remove(name);
  });
  return element("li", {}, choose, rename, remove);
}
