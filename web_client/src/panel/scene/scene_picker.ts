// Selects the scene: from a list, from a gallery, or by uploading a file.

import { favourites, favouritesFirst } from "../../common/favourites.ts";
import { ScenePreviews } from "../../previews/scene_previews.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createFileButton } from "../../widgets/file_button.ts";
import { createSceneGallery } from "./scene_gallery.ts";
import { keepUploads } from "./upload_lists.ts";

export function createScenePicker(viewer: Viewer, upload: (file: File) => void): HTMLElement[] {
  const previews = new ScenePreviews(viewer);
  const gallery = createSceneGallery(viewer);
  const toggle = button("Show thumbnails of all scenes", "grid", () => {
    gallery.hidden = !gallery.hidden;
    toggle.setAttribute("aria-expanded", String(!gallery.hidden));
    if (gallery.hidden) previews.stop();
    else void viewer.shown.readList().then(() => previews.start());
  });
  toggle.setAttribute("aria-expanded", "false");
  toggle.setAttribute("aria-controls", gallery.id);
  keepUploads(viewer, "scene", gallery);
  const select = sceneList(viewer);
  viewer.uploads.keep("scene", () => document.activeElement === select);
  // Then the page says so.
  viewer.uploads.keep("scene", () => viewer.scenes.value.scenes.length === 0);
  const file = createFileButton(viewer, {
    label: "Upload",
    tip: "Upload a scene file (.glb)",
    accept: ".glb",
    upload,
  });
  return [field("Scene", select, toggle, file), gallery];
}

function sceneList(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "scene",
    change: () => void viewer.loading.load(select.value),
    focus: () => void viewer.shown.readList(),
  });
  const update = (): void => {
    const { scenes, current } = viewer.scenes.value;
    const loading = viewer.loading.current.value;
    const options = favouritesFirst(scenes).map(({ name }) => ({
      value: name,
      label: favourites.value.has(name) ? `★ ${name}` : name,
    }));
    if (scenes.length === 0) {
      options.push({ value: "", label: viewer.hello ? "No scenes found" : "–" });
    } else if (!current && !loading) {
      options.unshift({ value: "", label: "Choose a scene" });
    }
    // Its file may have been deleted.
    if (current && !scenes.some(({ name }) => name === current)) {
      options.unshift({ value: current, label: current });
    }
    setOptions(select, options);
    select.value = (loading?.kind === "scene" ? loading.name : null) ?? current ?? "";
    // The closed list truncates long names.
    select.dataset.tip = select.value;
    select.disabled = loading !== null || scenes.length === 0;
  };
  viewer.scenes.watch(update);
  favourites.watch(update);
  viewer.loading.current.watch(update);
  viewer.connection.state.watch(update);
  return select;
}
