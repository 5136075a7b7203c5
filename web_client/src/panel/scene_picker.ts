// Which scene: a list, and a gallery of what this browser has seen of each.

import { thumbnailChanged, thumbnailOf } from "../thumbnails.ts";
import type { Viewer } from "../viewer.ts";
import { button, element, icon, setOptions } from "./element.ts";
import { field } from "./field.ts";

export function createScenePicker(viewer: Viewer): HTMLElement[] {
  const gallery = element("div", { class: "gallery", id: "scene-gallery", hidden: true });
  const toggle = button("Show all scenes as pictures", "grid", () => {
    gallery.hidden = !gallery.hidden;
    toggle.setAttribute("aria-expanded", String(!gallery.hidden));
    if (!gallery.hidden) void viewer.refreshScenes();
  });
  toggle.setAttribute("aria-expanded", "false");
  toggle.setAttribute("aria-controls", gallery.id);
  const fill = (): void => {
    const { scenes, current } = viewer.scenes.value;
    gallery.replaceChildren(
      ...scenes.map(({ name }) =>
        element(
          "button",
          {
            type: "button",
            class: "tile",
            "aria-pressed": String(name === current),
            click: () => void viewer.loadScene(name),
          },
          picture(thumbnailOf(name)),
          element("span", { class: "tile-name" }, name),
        ),
      ),
    );
  };
  viewer.scenes.watch(fill);
  thumbnailChanged.watch(fill);
  return [field("Scene", sceneList(viewer), toggle), gallery];
}

function picture(source: string | null): HTMLElement {
  if (source) return element("img", { src: source, alt: "", class: "tile-picture" });
  return element("span", { class: "tile-picture unseen" }, icon("scene"));
}

function sceneList(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "scene",
    change: () => void viewer.loadScene(select.value),
    focus: () => void viewer.refreshScenes(),
  });
  const update = (): void => {
    const { scenes, current } = viewer.scenes.value;
    const loading = viewer.loading.value;
    const options = scenes.map(({ name }) => ({ value: name, label: name }));
    if (scenes.length === 0) {
      options.push({ value: "", label: viewer.hello ? "No scenes found" : "–" });
    } else if (!current && !loading) {
      options.unshift({ value: "", label: "Choose a scene" });
    }
    setOptions(select, options);
    select.value = loading?.name ?? current ?? "";
    select.disabled = loading !== null || scenes.length === 0;
  };
  viewer.scenes.watch(update);
  viewer.loading.watch(update);
  viewer.connection.state.watch(update);
  return select;
}
