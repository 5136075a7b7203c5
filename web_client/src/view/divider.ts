// Two frames in one view: a divider between them, moved by dragging or by keys, both side by side,
// their difference, or one transparently over the other.

import { element, icon } from "../widgets/element.ts";

const keyStep = 2; // percent
const largeStep = 10;

export type CompareMode = "wipe" | "side" | "difference" | "overlay";

interface CompareLook {
  /** Of the upper frame, for "overlay". */
  opacity: number;
  /** Factor on the difference. */
  gain: number;
}

export interface Divider {
  setMode(mode: CompareMode, look: CompareLook): void;
  newCanvas(): HTMLCanvasElement;
  show(shown: boolean, label: string): void;
}

export function createDivider(root: HTMLElement): Divider {
  let canvas = element("canvas", { class: "second", "aria-hidden": "true" });
  let position = 50;
  let mode: CompareMode = "wipe";
  let shownText = "";
  let look: CompareLook = { opacity: 1, gain: 1 };
  const amplifier = element("div", { class: "amplifier" });
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
  root.append(canvas, amplifier, line, first, label);
  const draw = (): void => {
    const wipes = mode === "wipe";
    root.dataset.mode = mode;
    // The first frame takes half of the view, too.
    root.parentElement?.classList.toggle("side-by-side", mode === "side" && !root.hidden);
    canvas.style.clipPath = wipes ? `inset(0 0 0 ${position}%)` : "";
    canvas.style.opacity = mode === "overlay" ? String(look.opacity) : "";
    amplifier.style.backdropFilter = `brightness(${look.gain})`;
    label.textContent = mode === "difference" ? `Difference to ${shownText}` : shownText;
    line.hidden = !wipes;
    first.hidden = !wipes && mode !== "side";
    line.style.left = `${position}%`;
    first.style.right = wipes ? `${100 - position}%` : "";
    label.style.left = wipes ? `${position}%` : "";
    line.setAttribute("aria-valuenow", position.toFixed(0));
  };
  const set = (percent: number): void => {
    position = Math.max(0, Math.min(100, percent));
    draw();
  };
  draw();
  return {
    setMode(next, nextLook) {
      mode = next;
      look = nextLook;
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
      shownText = text;
      draw();
    },
  };
}
