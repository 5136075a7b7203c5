// Selects the environment map: from a list, by its thumbnail, or by uploading a file.

import type { EnvironmentInfo } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, icon, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createFileButton } from "../../widgets/file_button.ts";
import { showNodes, updateEntries } from "../../widgets/kept_nodes.ts";
import { createDeleteButton } from "./delete_button.ts";
import { keepUploads } from "./upload_lists.ts";

const withScene = "";
const withSceneLabel = "Automatic";

export function createEnvironmentField(
  viewer: Viewer,
  upload: (file: File) => void,
): HTMLElement[] {
  const { parts } = viewer;
  const select = element("select", {
    name: "environment",
    change: () => parts.chooseEnvironment(select.value || null),
    focus: () => void viewer.uploads.refresh("environment"),
  });
  const gallery = element("div", {
    class: "gallery environments",
    id: "environment-gallery",
    role: "group",
    "aria-label": "Environments",
    hidden: true,
  });
  const toggle = button("Show thumbnails of all environments", "grid", () => {
    gallery.hidden = !gallery.hidden;
    toggle.setAttribute("aria-expanded", String(!gallery.hidden));
    if (!gallery.hidden) fill();
  });
  toggle.setAttribute("aria-expanded", "false");
  toggle.setAttribute("aria-controls", gallery.id);
  const file = createFileButton(viewer, {
    label: "Upload an environment",
    tip: "Upload an environment (.hdr or .exr)",
    accept: ".hdr,.exr",
    upload,
  });
  const node = field("Environment", select, toggle, file);
  viewer.uploads.keep("environment", () => document.activeElement === select);
  keepUploads(viewer, "environment", gallery);
  const automatic = createTile(viewer, withScene, withSceneLabel);
  const tiles = new Map<string, EnvironmentTile>();
  const fill = (): void => {
    const state = parts.environment.value;
    if (!state || gallery.hidden) return;
    updateEntries(tiles, state.environments, ({ name }) => createFileTile(viewer, name));
    showNodes(gallery, [automatic, ...[...tiles.values()].map(({ node }) => node)]);
    for (const tile of gallery.querySelectorAll<HTMLElement>(".tile")) {
      const chosen = tile.dataset.environment === (state.current ?? withScene);
      tile.setAttribute("aria-pressed", String(chosen));
    }
  };
  parts.environment.watch((state) => {
    node.hidden = !state;
    if (!state) return;
    const names = state.environments.map(({ name }) => name);
    // Its file may have been deleted.
    if (state.current && !names.includes(state.current)) names.push(state.current);
    setOptions(select, [
      { value: withScene, label: withSceneLabel },
      ...names.map((name) => ({ value: name, label: name })),
    ]);
    select.value = state.current ?? withScene;
    fill();
  });
  return [node, gallery];
}

interface EnvironmentTile {
  node: HTMLElement;
  update(environment: EnvironmentInfo): void;
}

function createFileTile(viewer: Viewer, name: string): EnvironmentTile {
  const tile = createTile(viewer, name, name);
  const remove = createDeleteButton(viewer, "environment", name);
  let address = "";
  const update = ({ bytes, uploaded }: EnvironmentInfo): void => {
    remove.hidden = !uploaded;
    const url = thumbnailAddress(viewer, name, bytes);
    if (url !== address) tile.firstElementChild?.replaceWith(thumbnail(url));
    address = url;
  };
  return { node: element("div", { class: "tile-box" }, tile, remove), update };
}

function createTile(viewer: Viewer, value: string, label: string): HTMLElement {
  return element(
    "button",
    {
      type: "button",
      class: "tile",
      "data-environment": value,
      click: () => viewer.parts.chooseEnvironment(value || null),
    },
    placeholder(),
    element("span", { class: "tile-name" }, label),
  );
}

function placeholder(): HTMLElement {
  return element("span", { class: "tile-image placeholder" }, icon("sun"));
}

/** Another file of this name has another image, and thus another address. */
function thumbnailAddress({ connection, uploads }: Viewer, name: string, bytes: number): string {
  const path = name.split("/").map(encodeURIComponent).join("/");
  const url = connection.address.url(`api/v1/environments/${path}/thumbnail.png`);
  url.searchParams.set("bytes", String(bytes));
  url.searchParams.set("changes", String(uploads.changesOf("environment", name)));
  return url.href;
}

/** The server makes it from the file; where that fails a symbol is shown. */
function thumbnail(address: string): HTMLElement {
  const image = element("img", {
    src: address,
    alt: "",
    class: "tile-image",
    loading: "lazy",
    error: () => image.replaceWith(placeholder()),
  });
  return image;
}
