// The frame size to request: the canvas in device pixels, within limits.

import type { FrameSize } from "../session/stream_requests.ts";

interface SizeLimits {
  maxWidth: number;
  maxHeight: number;
  /** Most pixels of a frame; Infinity for no limit. */
  maxPixels: number;
}

const maxPixelRatio = 2;

/** A size with the view's aspect ratio, so that the frame fills it. Takes CSS pixels. */
export function frameSize(
  cssWidth: number,
  cssHeight: number,
  pixelRatio: number,
  limits: SizeLimits,
): FrameSize {
  const ratio = Math.min(maxPixelRatio, Math.max(0.5, pixelRatio));
  const width = Math.max(1, cssWidth * ratio);
  const height = Math.max(1, cssHeight * ratio);
  const scale = Math.min(
    1,
    limits.maxWidth / width,
    limits.maxHeight / height,
    Math.sqrt(limits.maxPixels / (width * height)),
  );
  return {
    width: Math.max(16, Math.round(width * scale)),
    height: Math.max(16, Math.round(height * scale)),
  };
}

/**
 * Where a point of the view lies in the frame, both in fractions of width and height: the view shows
 * the middle of frames of another shape.
 */
export function pointInFrame(
  view: { width: number; height: number },
  frame: FrameSize,
  x: number,
  y: number,
): { x: number; y: number } {
  const shape = (frame.height * view.width) / (frame.width * view.height);
  return {
    x: 0.5 + (x - 0.5) * Math.min(1, shape),
    y: 0.5 + (y - 0.5) * Math.min(1, 1 / shape),
  };
}

/** Reports changes of the element's size and the screen's pixel ratio. */
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
