// The line between two pictures that lie over each other: drag it, or move it by keys.

import { element, icon } from "../widgets/element.ts";

const keyStep = 2; // per cent
const largeStep = 10;

export interface Divider {
  /** Shows the second picture to the right of the line, or over all of the first, see-through. */
  arrange(as: "split" | "overlay", opacity: number): void;
  newCanvas(): HTMLCanvasElement;
  show(shown: boolean, label: string): void;
}

export function createDivider(root: HTMLElement): Divider {
  let canvas = element("canvas", { class: "second", "aria-hidden": "true" });
  let place = 50;
  let way: "split" | "overlay" = "split";
  let seeThrough = 1;
  const label = element("span", { class: "second-label" });
  const first = element("span", { class: "first-label" }, "This session");
  const handle = element("span", { class: "divider-handle" }, icon("code"));
  const line = element(
    "div",
    {
      class: "divider",
      role: "slider",
      tabindex: "0",
      "aria-label": "Line between the two pictures",
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
        set(place + step);
      },
    },
    handle,
  );
  root.append(canvas, line, first, label);
  const draw = (): void => {
    const split = way === "split";
    canvas.style.clipPath = split ? `inset(0 0 0 ${place}%)` : "";
    canvas.style.opacity = split ? "" : String(seeThrough);
    line.hidden = !split;
    first.hidden = !split;
    line.style.left = `${place}%`;
    first.style.right = `${100 - place}%`;
    label.style.left = split ? `${place}%` : "0";
    line.setAttribute("aria-valuenow", place.toFixed(0));
  };
  const set = (percent: number): void => {
    place = Math.max(0, Math.min(100, percent));
    draw();
  };
  draw();
  return {
    arrange(as, opacity) {
      way = as;
      seeThrough = opacity;
      draw();
    },
    newCanvas() {
      const fresh = element("canvas", { class: "second", "aria-hidden": "true" });
      canvas.replaceWith(fresh);
      canvas = fresh;
      draw();
      return fresh;
    },
    show(shown, text) {
      root.hidden = !shown;
      label.textContent = text;
    },
  };
}
