// The bookmarks of the scene: a thumbnail and a name each, which can be changed.

import { cropped } from "../../previews/thumbnails.ts";
import {
  type Bookmark,
  addBookmark,
  readBookmarks,
  removeBookmark,
  renameBookmark,
} from "../../session/bookmarks.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element } from "../../widgets/element.ts";

const thumbnailWidth = 112;

export function createBookmarkList(viewer: Viewer): { node: HTMLElement; add: () => void } {
  const list = element("ul", { class: "bookmarks", "aria-label": "Bookmarks" });
  const show = (): void => {
    const scene = viewer.scene.value?.name;
    const bookmarks = scene === undefined ? [] : readBookmarks(scene);
    list.hidden = bookmarks.length === 0;
    list.replaceChildren(
      ...bookmarks.map((bookmark) => createEntry(viewer, scene ?? "", bookmark, show)),
    );
  };
  const add = async (): Promise<void> => {
    const [scene, camera] = [viewer.scene.value, viewer.camera.value];
    if (!scene || !camera) return;
    const frame = await viewer.connection.copyFrame();
    const thumbnail = frame ? (cropped(frame, thumbnailWidth) ?? undefined) : undefined;
    frame?.close();
    const { name } = addBookmark(scene.name, camera, thumbnail).at(-1) as Bookmark;
    show();
    viewer.onInfo(`Bookmarked as ${name}`, "bookmark");
  };
  viewer.scene.watch(show);
  return { node: list, add: () => void add() };
}

function createEntry(
  viewer: Viewer,
  scene: string,
  { name, camera, thumbnail }: Bookmark,
  changed: () => void,
): HTMLElement {
  const image = element("img", { alt: "", class: "bookmark-image" });
  if (thumbnail) image.src = thumbnail;
  const choose = element(
    "button",
    { type: "button", class: "bookmark", click: () => viewer.cameraMoves.animateTo(camera) },
    thumbnail ? image : null,
    element("span", {}, name),
  );
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
    maxlength: "60",
    keydown: (event: KeyboardEvent) => {
      event.stopPropagation();
      cancelled = event.key === "Escape";
      if (event.key === "Enter" || event.key === "Escape") entry.blur();
    },
    blur: () => {
      if (!cancelled) renameBookmark(scene, name, entry.value);
      changed();
    },
  });
  entry.value = name;
  return element("li", {}, choose, rename, createRemoveButton(scene, name, changed));
}

/** Asks before it removes: the second click confirms. */
function createRemoveButton(scene: string, name: string, changed: () => void): HTMLElement {
  let asked = false;
  const remove = button(`Remove ${name}`, "close", () => {
    if (asked) {
      removeBookmark(scene, name);
      changed();
      return;
    }
    asked = true;
    remove.setAttribute("aria-label", `Confirm: remove ${name}`);
    remove.replaceChildren("Remove?");
    remove.classList.add("confirms");
  });
  remove.addEventListener("blur", () => {
    if (asked) changed();
  });
  return remove;
}
