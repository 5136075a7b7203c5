// Messages between the page and the stream worker.

import type { ViewCamera } from "./reprojection.ts";

/** A frame that was drawn. Times are milliseconds since the epoch, sub-millisecond. */
export interface DrawnFrame {
  frameSeq: number;
  inputSeqEcho: number;
  renderId: number;
  codec: number;
  width: number;
  height: number;
  samples: number;
  /** Converged: no better frame follows until something changes. */
  final: boolean;
  /** Revision of the session's state in this frame. */
  stateRev: number;
  quality: number;
  bytes: number;
  renderMs: number;
  encodeMs: number;
  decodeMs: number;
  receivedAt: number;
  drawnAt: number;
}

/** A camera that the page has sent to the server, as camera.set number `seq`. */
export interface PredictedCamera extends ViewCamera {
  seq: number;
}

/** The oldest frame to be shown. */
export interface FrameRequirement {
  oldestRev: number;
  /** The requested full size; older frames may have another one. */
  size?: { width: number; height: number };
}

export type ToWorker =
  | { kind: "canvas"; canvas: OffscreenCanvas }
  | { kind: "open"; url: string; subprotocol: string }
  | { kind: "close" }
  | { kind: "copy"; id: number }
  /** Whether every drawn frame is copied to the page, for a recording. */
  | { kind: "copy_frames"; enabled: boolean }
  /** Holds frames back until `release`. */
  | { kind: "hold" }
  | { kind: "release"; required: FrameRequirement }
  /** Shows the newest frame from this camera until a frame shows it; null: no longer. */
  | { kind: "predict"; camera: PredictedCamera | null }
  | { kind: "send"; text: string };

export type FromWorker =
  | { kind: "opened"; subprotocol: string }
  | { kind: "closed"; code: number; reason: string; wasOpen: boolean }
  | { kind: "text"; text: string }
  | { kind: "drawn"; frame: DrawnFrame }
  /** The newest frame was drawn from the predicted camera of this number. */
  | { kind: "predicted"; seq: number; drawnAt: number }
  | { kind: "cannot_predict" }
  /** Only without OffscreenCanvas: the page draws the image itself. */
  | { kind: "decoded"; image: ImageBitmap | VideoFrame; frame: DrawnFrame }
  /** Answers `copy` (null: nothing was drawn yet), or has id 0 for `copy_frames`. */
  | { kind: "copied"; id: number; image: ImageBitmap | null }
  /** A frame was lost; with `video`, all frames that depend on it as well. */
  | { kind: "decode_failed"; message: string; video: boolean };

/** Milliseconds on one clock for the page and its workers, whose time origins differ. */
export function clockMs(): number {
  return performance.timeOrigin + performance.now();
}
