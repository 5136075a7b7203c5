// Selects the environment map: from a list, by its thumbnail, or by uploading a file.

import type { EnvironmentState } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, icon, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createFileButton } from "../../widgets/file_button.ts";
import { createDeleteButton } from "./delete_button.ts";

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
  let shown = "";
  const fill = (): void => {
    const state = parts.environment.value;
    if (!state || gallery.hidden) return;
    const names = JSON.stringify(state.environments);
    // Rebuilt only when files are added or removed, so that a tile keeps the focus.
    if (shown !== names) gallery.replaceChildren(...tilesOf(viewer, state));
    shown = names;
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

function tilesOf(viewer: Viewer, { environments }: EnvironmentState): HTMLElement[] {
  const tile = (value: string, label: string, image: HTMLElement): HTMLElement =>
    element(
      "button",
      {
        type: "button",
        class: "tile",
        "data-environment": value,
        click: () => viewer.parts.chooseEnvironment(value || null),
      },
      image,
      element("span", { class: "tile-name" }, label),
    );
  return [
    tile(withScene, withSceneLabel, placeholder()),
    ...environments.map(({ name, bytes, uploaded }) =>
      element(
        "div",
        { class: "tile-box" },
        tile(name, name, thumbnail(viewer, name, bytes)),
        uploaded ? createDeleteButton(viewer, "environment", name) : null,
      ),
    ),
  ];
}

function placeholder(): HTMLElement {
  return element("span", { class: "tile-image placeholder" }, icon("sun"));
}

/** The server makes it from the file; where that fails a symbol is shown. */
function thumbnail(viewer: Viewer, name: string, bytes: number): HTMLElement {
  const path = name.split("/").map(encodeURIComponent).join("/");
  const url = viewer.connection.address.url(`api/v1/environments/${path}/thumbnail.png`);
  url.searchParams.set("bytes", String(bytes)); // another file of this name has another image
  const image = element("img", {
    src: url.href,
    alt: "",
    class: "tile-image",
    loading: "lazy",
    error: () => image.replaceWith(placeholder()),
  });
  return image;
}
