// What the page and the stream worker say to each other.

/** A frame that reached the canvas. Times are milliseconds since the epoch, sub-millisecond. */
export interface DrawnFrame {
  frameSeq: number;
  inputSeqEcho: number;
  renderId: number;
  codec: number;
  width: number;
  height: number;
  samples: number;
  /** Nothing better follows until something changes. */
  final: boolean;
  /** Revision of the session's state that it shows. */
  stateRev: number;
  quality: number;
  bytes: number;
  renderMs: number;
  encodeMs: number;
  decodeMs: number;
  receivedAt: number;
  drawnAt: number;
}

/** Which pictures are new enough to be shown. */
export interface Freshness {
  oldestRev: number;
  /** The full size that was asked for: older pictures may have another one. */
  size?: { width: number; height: number };
}

export type ToWorker =
  | { kind: "canvas"; canvas: OffscreenCanvas }
  | { kind: "open"; url: string; subprotocol: string }
  | { kind: "close" }
  | { kind: "copy"; id: number }
  /** Whether every drawn picture is copied to the page, for a recording. */
  | { kind: "copies"; wanted: boolean }
  /** From now on pictures wait, until `release` says which of them are new enough. */
  | { kind: "hold" }
  | { kind: "release"; from: Freshness }
  | { kind: "send"; text: string };

export type FromWorker =
  | { kind: "opened"; subprotocol: string }
  | { kind: "closed"; code: number; reason: string; wasOpen: boolean }
  | { kind: "text"; text: string }
  | { kind: "drawn"; frame: DrawnFrame }
  /** Only without OffscreenCanvas: the page draws the decoded picture itself. */
  | { kind: "picture"; picture: ImageBitmap | VideoFrame; frame: DrawnFrame }
  /** An answer to `copy` (null: nothing was drawn yet), or with id 0 a picture just drawn. */
  | { kind: "copied"; id: number; picture: ImageBitmap | null }
  /** A picture that was lost; of a video also those that would have built on it. */
  | { kind: "undecodable"; message: string; video: boolean };

/** One clock for the page and its workers, whose performance.now() start at different times. */
export function clockMs(): number {
  return performance.timeOrigin + performance.now();
}
