// The element of a handle: a slider for assistive technology, a sign in a round target for others.

import type { ViewPoint } from "../view/projection.ts";
import { element } from "../widgets/element.ts";
import type { Handle } from "./gizmo.ts";
import { svgShape } from "./svg_shape.ts";

const tips = {
  along: "Drag to move along this axis, or use the arrow keys.",
  across: "Drag to move across the view, or use the arrow keys.",
  turn: "Drag to turn, or use the arrow keys.",
};
/** To the right. */
const arrowPath = "M-7 -9 L11 0 L-7 9 L-3 0 Z";
const turnPath = "M4.2 -2.6 A5 5 0 1 0 4.9 1 M5 -6 V-2.4 H1.4";
const shiftTip = "Shift: finer drags, larger steps of the keys. Esc: back to where the drag began.";

export function createHandleNode({ id, label, deed }: Handle): HTMLElement {
  const sign = svgShape("svg", { viewBox: "-14 -14 28 28", "aria-hidden": "true" });
  sign.append(...signOf(id));
  return element(
    "div",
    {
      class: `gizmo gizmo-${id}`,
      role: "slider",
      tabindex: "0",
      "aria-label": label,
      "data-handle": id,
      "data-tip": tips[deed.kind],
      "data-tip-facts": shiftTip,
    },
    sign,
  );
}

/** `offset` is where the sign is seen from the gizmo's anchor: an arrow points there. */
export function placeHandleNode(node: HTMLElement, at: ViewPoint, offset: ViewPoint): void {
  node.style.translate = `${at.x.toFixed(1)}px ${at.y.toFixed(1)}px`;
  const angle = (Math.atan2(offset.y, offset.x) * 180) / Math.PI;
  node.querySelector(".turns")?.setAttribute("transform", `rotate(${angle.toFixed(1)})`);
}

export function describeHandleNode(node: HTMLElement, { value }: Handle): void {
  const number = (one: number): string => String(Number(one.toFixed(3)));
  node.setAttribute("aria-valuemin", number(value.least));
  node.setAttribute("aria-valuemax", number(value.most));
  node.setAttribute("aria-valuenow", number(value.now));
  node.setAttribute("aria-valuetext", value.text);
}

function signOf(id: Handle["id"]): SVGElement[] {
  if (id === "normal") return [svgShape("path", { class: "turns", d: arrowPath })];
  if (id === "centre") {
    return [svgShape("circle", { r: 7 }), svgShape("circle", { class: "hole", r: 2 })];
  }
  if (id === "turn") {
    return [svgShape("circle", { r: 10 }), svgShape("path", { class: "arc", d: turnPath })];
  }
  const letter = svgShape("text", { "text-anchor": "middle", y: 4 });
  letter.textContent = id.toUpperCase();
  return [svgShape("circle", { r: 10 }), letter];
}
