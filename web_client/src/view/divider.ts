// The divider between two overlaid frames, moved by dragging or by keys.

import { element, icon } from "../widgets/element.ts";

const keyStep = 2; // percent
const largeStep = 10;

export interface Divider {
  /** Shows the second frame right of the divider, or transparently over all of the first. */
  setMode(mode: "split" | "overlay", opacity: number): void;
  newCanvas(): HTMLCanvasElement;
  show(shown: boolean, label: string): void;
}

export function createDivider(root: HTMLElement): Divider {
  let canvas = element("canvas", { class: "second", "aria-hidden": "true" });
  let position = 50;
  let mode: "split" | "overlay" = "split";
  let overlayOpacity = 1;
  const label = element("span", { class: "second-label" });
  const first = element("span", { class: "first-label" }, "This session");
  const handle = element("span", { class: "divider-handle" }, icon("code"));
  const line = element(
    "div",
    {
      class: "divider",
      role: "slider",
      tabindex: "0",
      "aria-label": "Divider between the two frames",
      "aria-valuemin": "0",
      "aria-valuemax": "100",
      pointerdown: (event: PointerEvent) => {
        event.stopPropagation();
        line.setPointerCapture(event.pointerId);
      },
      pointermove: (event: PointerEvent) => {
        if (!line.hasPointerCapture(event.pointerId)) return;
        const { left, width } = root.getBoundingClientRect();
        set(((event.clientX - left) / width) * 100);
      },
      keydown: (event: KeyboardEvent) => {
        const size = event.shiftKey ? largeStep : keyStep;
        const step = { ArrowLeft: -size, ArrowRight: size, Home: -100, End: 100 }[event.key];
        if (step === undefined) return;
        event.preventDefault();
        event.stopPropagation();
        set(position + step);
      },
    },
    handle,
  );
  root.append(canvas, line, first, label);
  const draw = (): void => {
    const split = mode === "split";
    canvas.style.clipPath = split ? `inset(0 0 0 ${position}%)` : "";
    canvas.style.opacity = split ? "" : String(overlayOpacity);
    line.hidden = !split;
    first.hidden = !split;
    line.style.left = `${position}%`;
    first.style.right = `${100 - position}%`;
    label.style.left = split ? `${position}%` : "0";
    line.setAttribute("aria-valuenow", position.toFixed(0));
  };
  const set = (percent: number): void => {
    position = Math.max(0, Math.min(100, percent));
    draw();
  };
  draw();
  return {
    setMode(next, opacity) {
      mode = next;
      overlayOpacity = opacity;
      draw();
    },
    newCanvas() {
      const next = element("canvas", { class: "second", "aria-hidden": "true" });
      canvas.replaceWith(next);
      canvas = next;
      draw();
      return next;
    },
    show(shown, text) {
      root.hidden = !shown;
      label.textContent = text;
    },
  };
}
