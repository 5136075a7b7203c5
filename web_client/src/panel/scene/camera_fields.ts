// The cameras of the scene, bookmarks and "fit into view".

import { addBookmark, readBookmarks, removeBookmark } from "../../session/bookmarks.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, icon, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

const freeView = "";

export function createCameraFields(viewer: Viewer): HTMLElement[] {
  const chips = element("div", { class: "chips", role: "group", "aria-label": "Bookmarks" });
  const show = (): void => {
    const scene = viewer.scene.value;
    const bookmarks = scene ? readBookmarks(scene.name) : [];
    chips.hidden = bookmarks.length === 0;
    chips.replaceChildren(
      ...bookmarks.map(({ name, camera }) =>
        element(
          "span",
          { class: "chip removable" },
          element(
            "button",
            { type: "button", click: () => viewer.cameraMoves.animateTo(camera), "data-bookmark": name },
            name,
          ),
          element(
            "button",
            {
              type: "button",
              class: "remove",
              "aria-label": `Remove ${name}`,
              click: () => {
                if (scene) removeBookmark(scene.name, name);
                show();
              },
            },
            icon("close"),
          ),
        ),
      ),
    );
  };
  const add = (): void => {
    const scene = viewer.scene.value;
    const camera = viewer.camera.value;
    if (!scene || !camera) return;
    addBookmark(scene.name, camera);
    show();
  };
  viewer.scene.watch(show);
  const fit = button("Fit the scene into view (F)", "fit", () => void viewer.cameraMoves.fit());
  const bookmark = button("Bookmark this view (B)", "bookmark", add);
  viewer.addBookmark = add;
  return [field("Camera", cameraPicker(viewer), fit, bookmark), chips];
}

function cameraPicker(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "camera",
    change: () => {
      if (select.value !== freeView) void viewer.cameraMoves.select(select.value);
    },
  });
  const update = (): void => {
    const names = viewer.scene.value?.cameras ?? [];
    setOptions(select, [
      { value: freeView, label: "Free view" },
      ...names.map((name) => ({ value: name, label: name })),
    ]);
    const current = viewer.camera.value?.name ?? freeView;
    select.value = names.includes(current) ? current : freeView;
    select.disabled = names.length === 0;
  };
  viewer.scene.watch(update);
  viewer.camera.watch(update);
  return select;
}
