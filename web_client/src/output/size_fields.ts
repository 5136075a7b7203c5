// Width and height of an image, linked by the aspect ratio of the view unless that is unlocked.

import { button, element, uniqueId } from "../widgets/element.ts";

export interface ImageSize {
  width: number;
  height: number;
}

interface SizeFields {
  node: HTMLElement;
  value(): ImageSize;
  /** Starts with the view's size, within the server's limits. */
  show(size: ImageSize, limits: ImageSize): void;
  enable(enabled: boolean): void;
}

const smallest = 16;

/** The size with one changed side; with `aspect` the other side follows, and both keep the limits. */
export function resized(
  size: ImageSize,
  side: "width" | "height",
  pixels: number,
  aspect: number | null,
  limits: ImageSize,
): ImageSize {
  const clamped = (value: number, most: number): number =>
    Math.round(Math.min(most, Math.max(smallest, value)));
  if (aspect === null) return { ...size, [side]: clamped(pixels, limits[side]) };
  const most = Math.min(limits.width, limits.height * aspect);
  const least = Math.max(smallest, smallest * aspect);
  const width = Math.min(most, Math.max(least, side === "width" ? pixels : pixels * aspect));
  return { width: clamped(width, limits.width), height: clamped(width / aspect, limits.height) };
}

export function createSizeFields(): SizeFields {
  let size: ImageSize = { width: smallest, height: smallest };
  let limits: ImageSize = size;
  let aspect = 1;
  let linked = true;
  const entry = (side: "width" | "height", label: string): HTMLInputElement => {
    const input = element("input", {
      type: "text",
      inputmode: "numeric",
      autocomplete: "off",
      name: `image_${side}`,
      class: "number",
      "aria-label": label,
      change: () => {
        const pixels = Number(input.value);
        if (Number.isFinite(pixels) && pixels > 0) {
          size = resized(size, side, pixels, linked ? aspect : null, limits);
        }
        write();
      },
    });
    return input;
  };
  const [width, height] = [entry("width", "Width, pixels"), entry("height", "Height, pixels")];
  const link = button("Keep the aspect ratio", "link", () => {
    linked = !linked;
    if (linked) aspect = size.width / size.height;
    write();
  });
  const write = (): void => {
    width.value = String(size.width);
    height.value = String(size.height);
    link.setAttribute("aria-pressed", String(linked));
  };
  const id = uniqueId("field");
  width.id = id;
  const node = element(
    "div",
    { class: "field" },
    element("label", { for: id }, "Size"),
    element("div", { class: "field-controls size-fields" }, width, "×", height, link),
  );
  return {
    node,
    value: () => size,
    show(view, most) {
      [size, limits, aspect, linked] = [view, most, view.width / view.height, true];
      node.dataset.tip = `In pixels, up to ${most.width} × ${most.height}`;
      write();
    },
    enable(enabled) {
      width.disabled = height.disabled = link.disabled = !enabled;
    },
  };
}
