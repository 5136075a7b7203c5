// The size of the picture to ask for: the canvas in device pixels, within limits and a budget.

import type { FrameSize } from "../session/stream_requests.ts";

export interface SizeLimits {
  maxWidth: number;
  maxHeight: number;
  /** Most pixels worth asking for; Infinity asks for every device pixel. */
  maxPixels: number;
}

const sharpestPixelRatio = 2;

/** Keeps the shape of the view, so that the picture always fills it. CSS pixels in. */
export function frameSize(
  cssWidth: number,
  cssHeight: number,
  pixelRatio: number,
  limits: SizeLimits,
): FrameSize {
  const ratio = Math.min(sharpestPixelRatio, Math.max(0.5, pixelRatio));
  const width = Math.max(1, cssWidth * ratio);
  const height = Math.max(1, cssHeight * ratio);
  const shrink = Math.min(
    1,
    limits.maxWidth / width,
    limits.maxHeight / height,
    Math.sqrt(limits.maxPixels / (width * height)),
  );
  return {
    width: Math.max(16, Math.round(width * shrink)),
    height: Math.max(16, Math.round(height * shrink)),
  };
}

/** Reports every change of the element's size or the screen's pixel ratio. */
export function watchSize(element: HTMLElement, changed: () => void): void {
  new ResizeObserver(changed).observe(element);
  const watchRatio = (): void => {
    const query = matchMedia(`(resolution: ${devicePixelRatio}dppx)`);
    query.addEventListener(
      "change",
      () => {
        changed();
        watchRatio();
      },
      { once: true },
    );
  };
  watchRatio();
}
