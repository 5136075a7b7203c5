// Colours of colour inputs, which are sRGB, and linear ones (transfer function: IEC 61966-2-1).

import type { Vector3 } from "heliograph/json.ts";

export function displayColour(linear: Vector3): string {
  const byte = (value: number): string => {
    const encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
    return Math.round(Math.min(1, Math.max(0, encoded)) * 255)
      .toString(16)
      .padStart(2, "0");
  };
  return `#${linear.map(byte).join("")}`;
}

export function linearColour(display: string): Vector3 {
  const component = (start: number): number => {
    const value = Number.parseInt(display.slice(start, start + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  };
  return [component(1), component(3), component(5)];
}
