// The cameras of the scene, bookmarks and "fit into view".

import type { Viewer } from "../../session/viewer.ts";
import type { AutoRotate } from "../../view/auto_rotate.ts";
import type { PathPlayer } from "../../view/path_player.ts";
import type { PointPicker } from "../../view/picker.ts";
import { button, element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createBookmarkList } from "./bookmark_list.ts";
import { createLensFields } from "./lens_fields.ts";
import { type PathOptions, createPathFields } from "./path_fields.ts";
import { createViewButtons } from "./view_buttons.ts";

const freeView = "";

/** What moves the camera by itself, and how. */
export interface CameraTools {
  rotation: AutoRotate;
  player: PathPlayer;
  path: PathOptions;
  /** Takes the click that chooses what is in focus. */
  focus: PointPicker;
}

export function createCameraFields(viewer: Viewer, tools: CameraTools): HTMLElement[] {
  const bookmarks = createBookmarkList(viewer);
  const fit = button("Fit the scene into view (F)", "fit", () => void viewer.cameraMoves.fit());
  const bookmark = button("Bookmark this view (B)", "bookmark", bookmarks.add);
  viewer.addBookmark = bookmarks.add;
  const views = createViewButtons(viewer, tools.rotation);
  return [
    field("Camera", cameraPicker(viewer), fit, bookmark),
    views,
    createLensFields(viewer, tools.focus),
    bookmarks.node,
    createPathFields(viewer, tools.player, tools.path),
  ];
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
