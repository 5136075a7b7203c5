// The direction of a directional light as a point on a disc: the edge is the horizon, the centre
// the zenith; the disc is a map seen from above, with +Z down.

import type { Vector3 } from "heliograph/json.ts";
import { normalize, scale } from "../../common/vector.ts";
import { element } from "../../widgets/element.ts";
import { isDisabled } from "../../widgets/requires_control.ts";

const keyStep = 2; // degrees
const largeStep = 10;

/** Azimuth clockwise from -Z seen from above, elevation over the horizon; degrees. */
interface SunPosition {
  azimuth: number;
  elevation: number;
}

export function sunPosition(direction: Vector3): SunPosition {
  const [x, y, z] = scale(normalize(direction), -1);
  return {
    azimuth: (Math.atan2(x, -z) * 180) / Math.PI,
    elevation: (Math.asin(Math.max(-1, Math.min(1, y))) * 180) / Math.PI,
  };
}

export function sunDirection({ azimuth, elevation }: SunPosition): Vector3 {
  const [turn, rise] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
  const level = Math.cos(rise);
  return [-Math.sin(turn) * level, -Math.sin(rise), Math.cos(turn) * level];
}

interface SunDial {
  node: HTMLElement;
  show(direction: Vector3): void;
}

export function createSunDial(label: string, changed: (direction: Vector3) => void): SunDial {
  let position: SunPosition = { azimuth: 0, elevation: 90 };
  const knob = element("span", { class: "sun-knob" });
  const disc = element(
    "div",
    {
      class: "sun-dial",
      role: "slider",
      tabindex: "0",
      "aria-label": label,
      "aria-valuemin": "-180",
      "aria-valuemax": "180",
      "data-tip": "Drag to set the direction, or use the arrow keys (with Shift: larger steps).",
      pointerdown: (event: PointerEvent) => {
        if (isDisabled(disc)) return;
        disc.setPointerCapture(event.pointerId);
        setFromPointer(event);
      },
      pointermove: (event: PointerEvent) => {
        if (disc.hasPointerCapture(event.pointerId)) setFromPointer(event);
      },
      keydown: (event: KeyboardEvent) => step(event),
    },
    knob,
  );
  const set = (next: SunPosition): void => {
    const azimuth = ((next.azimuth + 540) % 360) - 180;
    position = { azimuth, elevation: Math.max(1, Math.min(90, next.elevation)) };
    draw();
    changed(sunDirection(position));
  };
  const setFromPointer = (event: PointerEvent): void => {
    const { left, top, width, height } = disc.getBoundingClientRect();
    const x = ((event.clientX - left) / width) * 2 - 1;
    const y = ((event.clientY - top) / height) * 2 - 1;
    const radius = Math.min(1, Math.hypot(x, y));
    set({ azimuth: (Math.atan2(x, -y) * 180) / Math.PI, elevation: 90 * (1 - radius) });
  };
  const step = (event: KeyboardEvent): void => {
    const size = event.shiftKey ? largeStep : keyStep;
    const [turn, lift] = {
      ArrowLeft: [-size, 0],
      ArrowRight: [size, 0],
      ArrowUp: [0, size],
      ArrowDown: [0, -size],
    }[event.key] ?? [0, 0];
    if (!turn && !lift) return;
    event.preventDefault();
    if (isDisabled(disc)) return;
    set({ azimuth: position.azimuth + (turn ?? 0), elevation: position.elevation + (lift ?? 0) });
  };
  const draw = (): void => {
    const radius = 1 - Math.max(0, position.elevation) / 90;
    const turn = (position.azimuth * Math.PI) / 180;
    knob.style.left = `${50 + 50 * radius * Math.sin(turn)}%`;
    knob.style.top = `${50 - 50 * radius * Math.cos(turn)}%`;
    const [azimuth, elevation] = [position.azimuth.toFixed(0), position.elevation.toFixed(0)];
    disc.setAttribute("aria-valuenow", azimuth);
    disc.setAttribute("aria-valuetext", `${azimuth}° azimuth, ${elevation}° elevation`);
  };
  return {
    node: disc,
    show(direction) {
      position = sunPosition(direction);
      draw();
    },
  };
}
