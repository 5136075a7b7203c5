// Selects the scene: from a list, from a gallery, or by uploading a file.

import { ScenePreviews } from "../../previews/scene_previews.ts";
import { thumbnailChanged, thumbnailOf } from "../../previews/thumbnails.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, icon, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

export function createScenePicker(viewer: Viewer, upload: (file: File) => void): HTMLElement[] {
  const previews = new ScenePreviews(viewer);
  const gallery = createGallery(viewer);
  const toggle = button("Show thumbnails of all scenes", "grid", () => {
    gallery.hidden = !gallery.hidden;
    toggle.setAttribute("aria-expanded", String(!gallery.hidden));
    if (gallery.hidden) previews.stop();
    else void viewer.refreshScenes().then(() => previews.start());
  });
  toggle.setAttribute("aria-expanded", "false");
  toggle.setAttribute("aria-controls", gallery.id);
  return [field("Scene", sceneList(viewer), toggle, fileButton(viewer, upload)), gallery];
}

function createGallery(viewer: Viewer): HTMLElement {
  const gallery = element("div", { class: "gallery", id: "scene-gallery", hidden: true });
  const tiles = new Map<string, HTMLElement>();
  let shown = "";
  const fill = (): void => {
    const { scenes, current } = viewer.scenes.value;
    const names = scenes.map(({ name }) => name);
    // Rebuilt only when scenes are added or removed, so that a tile keeps the focus.
    if (shown !== names.join("\n")) {
      shown = names.join("\n");
      tiles.clear();
      for (const name of names) tiles.set(name, createTile(viewer, name));
      gallery.replaceChildren(...tiles.values());
    }
    for (const [name, tile] of tiles) tile.setAttribute("aria-pressed", String(name === current));
  };
  viewer.scenes.watch(fill);
  thumbnailChanged.watch((name) => {
    tiles.get(name)?.firstElementChild?.replaceWith(thumbnail(thumbnailOf(name)));
  });
  return gallery;
}

function createTile(viewer: Viewer, name: string): HTMLElement {
  return element(
    "button",
    { type: "button", class: "tile", click: () => void viewer.loading.load(name) },
    thumbnail(thumbnailOf(name)),
    element("span", { class: "tile-name" }, name),
  );
}

function thumbnail(source: string | null): HTMLElement {
  if (source) return element("img", { src: source, alt: "", class: "tile-image" });
  return element("span", { class: "tile-image placeholder" }, icon("scene"));
}

/** An alternative to dropping a file; hidden where the server does not accept uploads. */
function fileButton(viewer: Viewer, upload: (file: File) => void): HTMLElement {
  const input = element("input", {
    type: "file",
    accept: ".glb",
    hidden: true,
    change: () => {
      const file = input.files?.[0];
      if (file) upload(file);
      input.value = "";
    },
  });
  const opener = button("Upload", "upload", () => input.click());
  opener.dataset.tip = "Upload a scene file (.glb)";
  opener.hidden = true;
  viewer.connection.state.watch((state) => {
    if (state.kind === "live") opener.hidden = !state.hello.limits.max_upload_bytes;
  });
  return element("span", { class: "file-button" }, opener, input);
}

function sceneList(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "scene",
    change: () => void viewer.loading.load(select.value),
    focus: () => void viewer.refreshScenes(),
  });
  const update = (): void => {
    const { scenes, current } = viewer.scenes.value;
    const loading = viewer.loading.current.value;
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
  viewer.loading.current.watch(update);
  viewer.connection.state.watch(update);
  return select;
}
