// Draws what other viewers point at over the view: arrows with their names, which follow the camera of
// the page. Tells them what this page's user points at.

import type { Pointer } from "../session/company/pointers.ts";
import type { Viewer } from "../session/viewer.ts";
import { Projection } from "../view/projection.ts";
import { element, setText } from "../widgets/element.ts";
import { colourOfViewer, nameOfViewer } from "./viewer_identity.ts";

const svgNamespace = "http://www.w3.org/2000/svg";
/** Its tip is at the origin. */
const arrowPath = "M0 0 L4.2 14.5 L7.4 8.6 L13.8 6.6 Z";

export function mountPointers(root: HTMLElement, canvas: HTMLElement, viewer: Viewer): void {
  const { pointers } = viewer.company;
  const arrows = new Map<string, HTMLElement>();
  let scheduled = false;
  const draw = (): void => {
    scheduled = false;
    const [camera, frame] = [viewer.camera.value, viewer.frame.value];
    const shown = viewer.scene.value && camera && frame ? pointers.others.value : [];
    for (const [id, arrow] of arrows) {
      if (shown.some((one) => one.viewer === id)) continue;
      arrow.remove();
      arrows.delete(id);
    }
    if (!camera || !frame) return;
    const { clientWidth: width, clientHeight: height } = root;
    const projection = new Projection(camera, frame.width / frame.height, width, height);
    for (const one of shown) {
      const arrow = arrows.get(one.viewer) ?? createArrow(one.viewer);
      if (!arrows.has(one.viewer)) root.append(arrow);
      arrows.set(one.viewer, arrow);
      place(arrow, one, projection);
      setText(arrow.lastElementChild as Element, one.name || nameOfViewer(viewer, one.viewer));
    }
  };
  const schedule = (): void => {
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(draw);
  };
  const { camera, frame, scene, membership } = viewer;
  for (const signal of [camera, frame, scene, pointers.others, membership.session]) {
    (signal as { watch(listener: () => void): void }).watch(schedule);
  }
  new ResizeObserver(schedule).observe(root);
  watchOwn(canvas, viewer);
}

function createArrow(viewer: string): HTMLElement {
  const svg = document.createElementNS(svgNamespace, "svg");
  const path = document.createElementNS(svgNamespace, "path");
  path.setAttribute("d", arrowPath);
  svg.append(path);
  const arrow = element("div", { class: "pointer", "data-viewer": viewer }, svg, element("span"));
  arrow.style.setProperty("--colour", colourOfViewer(viewer));
  return arrow;
}

function place(arrow: HTMLElement, { position, faded }: Pointer, projection: Projection): void {
  const at = projection.point(position);
  arrow.hidden = at === null;
  arrow.classList.toggle("faded", faded);
  if (at) arrow.style.translate = `${at.x.toFixed(1)}px ${at.y.toFixed(1)}px`;
}

/** A pressed button moves the camera: then nothing is pointed at. Nor do fingers point. */
function watchOwn(canvas: HTMLElement, { company, scene }: Viewer): void {
  canvas.addEventListener("pointermove", ({ clientX, clientY, buttons, pointerType }) => {
    if (buttons !== 0 || pointerType === "touch" || !scene.value) return;
    const { left, top, width, height } = canvas.getBoundingClientRect();
    company.pointers.movedTo({ x: (clientX - left) / width, y: (clientY - top) / height });
  });
  canvas.addEventListener("pointerleave", () => company.pointers.left());
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) company.pointers.left();
  });
}
