// All scenes with thumbnails: searched by name, favourites first.

import type { SceneEntry } from "heliograph/messages.ts";
import { favourites, favouritesFirst, setFavourite } from "../../common/favourites.ts";
import { thumbnailChanged, thumbnailOf } from "../../previews/thumbnails.ts";
import type { Viewer } from "../../session/viewer.ts";
import { element, icon, setText } from "../../widgets/element.ts";
import { showNodes, updateEntries } from "../../widgets/kept_nodes.ts";
import { createDeleteButton } from "./delete_button.ts";

interface SceneTile {
  node: HTMLElement;
  choose: HTMLButtonElement;
  star: HTMLButtonElement;
  update(scene: SceneEntry): void;
}

export function createSceneGallery(viewer: Viewer): HTMLElement {
  const tiles = new Map<string, SceneTile>();
  const grid = element("div", { class: "gallery" });
  const noResults = element("p", { class: "facts", role: "status" });
  const search = element("input", {
    type: "search",
    name: "scene_search",
    placeholder: "Search scenes",
    "aria-label": "Search scenes",
    autocomplete: "off",
    spellcheck: "false",
    input: () => filter(),
  });
  const filter = (): void => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let found = 0;
    for (const [name, { node }] of tiles) {
      const text = name.toLowerCase().replaceAll("_", " ");
      node.hidden = !words.every((word) => text.includes(word) || name.includes(word));
      if (!node.hidden) found += 1;
    }
    setText(noResults, found > 0 || tiles.size === 0 ? "" : "No scene has this name.");
  };
  let shown = "";
  const fill = (): void => {
    const { scenes, current } = viewer.scenes.value;
    const entries = scenes.map(({ name, uploaded }) => `${name} ${uploaded}`).join("\n");
    // Sorted only when scenes are added or removed, so that none moves while it is chosen.
    if (shown !== entries) {
      shown = entries;
      updateEntries(tiles, favouritesFirst(scenes), ({ name }) => createTile(viewer, name));
      showNodes(
        grid,
        [...tiles.values()].map(({ node }) => node),
      );
      filter();
    }
    for (const [name, { choose }] of tiles) {
      choose.setAttribute("aria-pressed", String(name === current));
    }
  };
  viewer.scenes.watch(fill);
  favourites.watch((names) => {
    for (const [name, { star }] of tiles)
      star.setAttribute("aria-pressed", String(names.has(name)));
  });
  thumbnailChanged.watch((name) => {
    tiles.get(name)?.choose.firstElementChild?.replaceWith(thumbnail(thumbnailOf(name)));
  });
  return element(
    "div",
    { class: "scene-gallery", id: "scene-gallery", hidden: true },
    element("div", { class: "search" }, icon("search"), search),
    noResults,
    grid,
  );
}

function createTile(viewer: Viewer, name: string): SceneTile {
  const choose = element(
    "button",
    { type: "button", class: "tile", click: () => void viewer.loading.load(name) },
    thumbnail(thumbnailOf(name)),
    element("span", { class: "tile-name" }, name),
  );
  const star = element(
    "button",
    {
      type: "button",
      class: "star",
      "aria-label": `Favourite ${name}`,
      "aria-pressed": String(favourites.value.has(name)),
      "data-tip": "Favourites come first in the list of scenes",
      click: () => setFavourite(name, !favourites.value.has(name)),
    },
    icon("star"),
  );
  const remove = createDeleteButton(viewer, "scene", name);
  const node = element("div", { class: "tile-box" }, choose, star, remove);
  const update = ({ uploaded }: SceneEntry): void => void (remove.hidden = !uploaded);
  return { node, choose, star, update };
}

function thumbnail(source: string | null): HTMLElement {
  if (source) return element("img", { src: source, alt: "", class: "tile-image" });
  return element("span", { class: "tile-image placeholder" }, icon("scene"));
}
