// Selects the buffer that is shown, by name or by thumbnail.

import { humanise } from "heliograph/settings_schema.ts";
import { type Viewer, bufferSetting } from "../../session/viewer.ts";
import { button, element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

const thumbnailWidth = 160;

export const bufferLabel = (name: string): string => humanise(name.replaceAll(".", " · "));

export function createBufferFields(viewer: Viewer): HTMLElement[] {
  const gallery = element("div", { class: "gallery", id: "buffer-gallery", hidden: true });
  const tiles = new Map<string, HTMLElement>();
  let generation = 0;
  const fill = (): void => {
    tiles.clear();
    gallery.replaceChildren(
      ...viewer.capabilities.buffers.value.map(({ name, description }) => {
        const tile = element(
          "button",
          {
            type: "button",
            class: "tile",
            "data-buffer": name,
            "data-tip": description,
            click: () => viewer.settings.change(bufferSetting, name),
          },
          element("span", { class: "tile-image" }),
          element("span", { class: "tile-name" }, bufferLabel(name)),
        );
        tiles.set(name, tile);
        return tile;
      }),
    );
    mark();
  };
  const mark = (): void => {
    const shown = viewer.settings.value(bufferSetting);
    for (const [name, tile] of tiles) tile.setAttribute("aria-pressed", String(name === shown));
  };
  /**
   * One capture after another, so that thumbnails do not block the renderer: of one sample, which
   * is there at once, then of the converged image.
   */
  const loadThumbnails = async (): Promise<void> => {
    const own = ++generation;
    for (const samples of [1, undefined]) {
      for (const [name, tile] of [...tiles]) {
        if (gallery.hidden || own !== generation || !viewer.hello) return;
        const source = await viewer.queries
          .thumbnail(name, thumbnailWidth, samples)
          .catch(() => null);
        if (!source) continue;
        const image = element("img", { class: "tile-image", alt: "", src: source });
        image.dataset.samples = samples === undefined ? "all" : String(samples);
        tile.firstElementChild?.replaceWith(image);
      }
    }
  };
  const toggle = button("Show thumbnails of all buffers", "grid", () => {
    gallery.hidden = !gallery.hidden;
    toggle.setAttribute("aria-expanded", String(!gallery.hidden));
    if (!gallery.hidden) void loadThumbnails();
  });
  toggle.setAttribute("aria-expanded", "false");
  toggle.setAttribute("aria-controls", gallery.id);
  viewer.capabilities.buffers.watch(() => {
    fill();
    if (!gallery.hidden) void loadThumbnails();
  });
  viewer.settings.tree.watch(mark);
  return [field("Buffer", bufferPicker(viewer), toggle), gallery];
}

function bufferPicker(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "buffer",
    change: () => viewer.settings.change(bufferSetting, select.value),
  });
  const update = (): void => {
    const shown = String(viewer.settings.value(bufferSetting) ?? "output");
    const buffers = viewer.capabilities.buffers.value;
    const known = buffers.some(({ name }) => name === shown);
    const names = known ? buffers.map(({ name }) => name) : [shown, ...buffers.map((b) => b.name)];
    setOptions(
      select,
      names.map((name) => ({ value: name, label: bufferLabel(name) })),
    );
    select.value = shown;
    select.dataset.tip =
      buffers.find(({ name }) => name === shown)?.description || "The buffer to show";
  };
  viewer.capabilities.buffers.watch(update);
  viewer.settings.tree.watch(update);
  return select;
}
