// The textures of a material: a row for each slot, with the uploaded images that can take its place.

import { humanise } from "heliograph/settings_schema.ts";
import type { TextureChoice, Textures } from "../../session/edits/textures.ts";
import { describeFileTexture } from "../../session/edits/textures.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createFileButton } from "../../widgets/file_button.ts";
import { showNodes, updateEntries } from "../../widgets/kept_nodes.ts";
import { createDeleteButton } from "./delete_button.ts";
import { keepUploads } from "./upload_lists.ts";

/** File names that the server takes as images. */
const imageFiles = ".png,.jpg,.jpeg,.webp,.ktx2";
const ofFile = "file";
const none = "none";
const imagePrefix = "image ";

interface TextureRows {
  node: HTMLElement;
  /** Shows the textures of the material of this name. */
  show(material: string): void;
}

/** `upload` gives the name of the image on the server; null where it was not taken. */
export function createTextureRows(
  viewer: Viewer,
  upload: (file: File) => Promise<string | null>,
): TextureRows {
  const { textures } = viewer;
  let material = "";
  let rows: Row[] = [];
  const images = createImageList(viewer);
  const node = element("div", { class: "texture-rows" });
  const change = async (slot: string, choice: TextureChoice): Promise<void> => {
    await textures.choose(material, slot, choice);
    show(material);
  };
  const replace = async (slot: string, file: File): Promise<void> => {
    const of = material;
    const image = await upload(file);
    if (image !== null) await textures.choose(of, slot, { image });
    show(material);
  };
  const show = (name: string): void => {
    material = name;
    for (const row of rows) row.show(name);
  };
  let slots = "";
  textures.list.watch((list) => {
    node.hidden = list === null;
    const names = list?.slots ?? [];
    // Made again only for another server, so that a row keeps the focus.
    if (slots !== names.join()) {
      slots = names.join();
      rows = names.map((slot) => createRow(viewer, slot, change, replace));
      node.replaceChildren(...rows.map((row) => row.node), images);
    }
    show(material);
  });
  textures.images.watch(() => show(material));
  keepUploads(viewer, "image", node);
  return { node, show };
}

/** The uploaded images, which can be deleted. */
function createImageList(viewer: Viewer): HTMLElement {
  const list = element("ul", { class: "bookmarks", "aria-label": "Uploaded images" });
  const entries = new Map<string, { node: HTMLElement }>();
  viewer.textures.images.watch((images) => {
    const uploaded = images.filter((image) => image.uploaded);
    updateEntries(entries, uploaded, ({ name }) => ({
      node: element(
        "li",
        {},
        element("span", { class: "uploaded-image" }, name),
        createDeleteButton(viewer, "image", name),
      ),
    }));
    list.hidden = entries.size === 0;
    showNodes(
      list,
      [...entries.values()].map(({ node }) => node),
    );
  });
  return list;
}

interface Row {
  node: HTMLElement;
  show(material: string): void;
}

function createRow(
  viewer: Viewer,
  slot: string,
  change: (slot: string, choice: TextureChoice) => Promise<void>,
  replace: (slot: string, file: File) => Promise<void>,
): Row {
  const label = humanise(slot);
  let viewedMaterial = "";
  const select = element("select", {
    name: `texture_${slot}`,
    change: () => void change(slot, choiceFor(select.value)),
  });
  const file = createFileButton(viewer, {
    label: `Replace the ${label.toLowerCase()} texture by a file`,
    tip: "Replace it by an image (PNG, JPEG, WebP or KTX2)",
    accept: imageFiles,
    upload: (chosen) => void replace(slot, chosen),
  });
  const remove = button(`Remove the ${label.toLowerCase()} texture`, "close", () => {
    const own = viewer.textures.find(viewedMaterial, slot)?.file_image !== undefined;
    void change(slot, own ? { removed: true } : { image: null });
  });
  const restore = button(`Restore the ${label.toLowerCase()} texture of the file`, "reset", () => {
    void change(slot, { image: null });
  });
  const node = field(label, select, file, remove, restore);
  acceptDrop(node, viewer, (dropped) => void replace(slot, dropped));
  const show = (material: string): void => {
    viewedMaterial = material;
    const texture = viewer.textures.find(material, slot);
    setOptions(select, optionsOf(viewer.textures, material, slot));
    select.value = valueOf(texture);
    const changed = texture !== undefined && (texture.removed || texture.image !== undefined);
    remove.hidden = texture === undefined || texture.removed;
    restore.hidden = !changed;
  };
  return { node, show };
}

function valueOf(texture: { image?: string; removed: boolean } | undefined): string {
  if (texture?.removed) return none;
  return texture?.image === undefined ? ofFile : imagePrefix + texture.image;
}

function choiceFor(value: string): TextureChoice {
  if (value === none) return { removed: true };
  return { image: value === ofFile ? null : value.slice(imagePrefix.length) };
}

export function optionsOf(
  textures: Pick<Textures, "find" | "images">,
  material: string,
  slot: string,
): { value: string; label: string }[] {
  const texture = textures.find(material, slot);
  const own = texture?.file_image !== undefined;
  const file = describeFileTexture(texture);
  const names = textures.images.value.map(({ name }) => name);
  // One that the server has no longer is still shown.
  if (texture?.image !== undefined && !names.includes(texture.image)) names.push(texture.image);
  return [
    { value: ofFile, label: own ? `As in the file: ${file}` : "None, as in the file" },
    ...(own || texture?.removed ? [{ value: none, label: "None" }] : []),
    ...names.map((name) => ({ value: imagePrefix + name, label: name })),
  ];
}

/** A file that is dropped on the row is for its slot, and no scene. */
function acceptDrop(node: HTMLElement, viewer: Viewer, drop: (file: File) => void): void {
  node.addEventListener("drop", (event) => {
    const file = event.dataTransfer?.files[0];
    if (!file || !viewer.mayChange) return;
    event.preventDefault();
    drop(file);
  });
}
