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
  quality: number;
  bytes: number;
  renderMs: number;
  encodeMs: number;
  decodeMs: number;
  receivedAt: number;
  drawnAt: number;
}

export type ToWorker =
  | { kind: "canvas"; canvas: OffscreenCanvas }
  | { kind: "open"; url: string; subprotocol: string }
  | { kind: "close" }
  /** From now on pictures wait, until `release` says which state of the session is new enough. */
  | { kind: "copy"; id: number }
  /** Whether every drawn picture is copied to the page, for a recording. */
  | { kind: "copies"; wanted: boolean }
  | { kind: "hold" }
  | { kind: "release"; oldestRev: number }
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
  | { kind: "undecodable"; message: string };

/** One clock for the page and its workers, whose performance.now() start at different times. */
export function clockMs(): number {
  return performance.timeOrigin + performance.now();
}
