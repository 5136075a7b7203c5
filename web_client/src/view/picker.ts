// Takes clicks on the picture that are not the start of a drag.

import type { InspectorHost } from "../panel/inspector.ts";

const mostMovement = 4; // CSS pixels

export function createPicker(surface: HTMLElement, mark: HTMLElement): InspectorHost {
  let take: ((x: number, y: number) => void) | null = null;
  let pressed: { x: number; y: number } | null = null;
  surface.addEventListener("pointerdown", ({ clientX, clientY, button }) => {
    pressed = button === 0 ? { x: clientX, y: clientY } : null;
  });
  surface.addEventListener("pointerup", ({ clientX, clientY }) => {
    const from = pressed;
    pressed = null;
    if (!take || !from) return;
    if (Math.hypot(clientX - from.x, clientY - from.y) > mostMovement) return;
    const { left, top, width, height } = surface.getBoundingClientRect();
    take((clientX - left) / width, (clientY - top) / height);
  });
  return {
    onPictureClick(taker) {
      take = taker;
      surface.classList.toggle("picking", taker !== null);
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
