// Clicks on the view that do not start a drag.

type ClickListener = (x: number, y: number, event: PointerEvent) => void;

export interface PointPicker {
  /**
   * Sends every click, in fractions of width and height, to the function, but for those that another
   * picker has taken by `preventDefault`; null stops it.
   */
  onClick(listener: ClickListener | null): void;
  /** Marks a point of the image. */
  mark(x: number, y: number): void;
  unmark(): void;
}

const maxMovement = 4; // CSS pixels

/** The pickers of a surface that have a listener. */
const picking = new WeakMap<HTMLElement, Set<PointPicker>>();

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
    if (!listener || !from || event.defaultPrevented) return;
    if (Math.hypot(clientX - from.x, clientY - from.y) > maxMovement) return;
    const { left, top, width, height } = surface.getBoundingClientRect();
    listener((clientX - left) / width, (clientY - top) / height, event);
  });
  const active = picking.get(surface) ?? new Set();
  picking.set(surface, active);
  const picker: PointPicker = {
    onClick(next) {
      listener = next;
      if (next) active.add(picker);
      else active.delete(picker);
      surface.classList.toggle("picking", active.size > 0);
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
  return picker;
}
