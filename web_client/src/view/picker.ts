// Clicks on the view that do not start a drag.

type ClickListener = (x: number, y: number, event: PointerEvent) => void;

export interface PointPicker {
  /** Sends every click, in fractions of width and height, to the function; null stops it. */
  onClick(listener: ClickListener | null): void;
  /** Marks a point of the image. */
  mark(x: number, y: number): void;
  unmark(): void;
}

const maxMovement = 4; // CSS pixels

export function createPicker(surface: HTMLElement, mark: HTMLElement): PointPicker {
  let listener: ClickListener | null = null;
  let pressed: { x: number; y: number } | null = null;
  surface.addEventListener("pointerdown", ({ clientX, clientY, button }) => {
    pressed = button === 0 ? { x: clientX, y: clientY } : null;
  });
  surface.addEventListener("pointerup", (event) => {
    const { clientX, clientY } = event;
    const from = pressed;
    pressed = null;
    if (!listener || !from) return;
    if (Math.hypot(clientX - from.x, clientY - from.y) > maxMovement) return;
    const { left, top, width, height } = surface.getBoundingClientRect();
    listener((clientX - left) / width, (clientY - top) / height, event);
  });
  return {
    onClick(next) {
      listener = next;
      surface.classList.toggle("picking", next !== null);
    },
    mark(x, y) {
      mark.hidden = false;
      mark.style.left = `${x * 100}%`;
      mark.style.top = `${y * 100}%`;
    },
    unmark() {
      mark.hidden = true;
    },
  };
}
