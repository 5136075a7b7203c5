// How fast and how soon frames are shown: those of the server, and those with images that were
// reprojected between them.

import { LatencyMeter } from "./latency.ts";
import { RateMeter } from "./rates.ts";
import type { DrawnFrame } from "./worker_messages.ts";

export class FrameMeters {
  /** From an input to the first frame of the server that shows it. */
  readonly latency = new LatencyMeter();
  /** From an input to the first image that shows it: a frame, or one that was reprojected. */
  readonly responses = new LatencyMeter();
  readonly rates = new RateMeter();
  /** Of all images that are shown. */
  readonly shownRates = new RateMeter();
  /** Of the newest camera that a reprojected image has shown. */
  private predictedSeq = 0;

  frameDrawn(frame: DrawnFrame): void {
    this.rates.add(frame.drawnAt, frame.bytes);
    // Frames that are behind the camera have been counted as they were reprojected.
    if (frame.inputSeqEcho >= this.predictedSeq) this.shownRates.add(frame.drawnAt, 0);
    this.latency.frameDrawn(frame.inputSeqEcho, frame.drawnAt);
    this.responses.frameDrawn(frame.inputSeqEcho, frame.drawnAt);
  }

  /** The newest frame was shown from the camera that was sent with `seq`. */
  predicted(seq: number, drawnAt: number): void {
    this.predictedSeq = seq;
    this.shownRates.add(drawnAt, 0);
    this.responses.frameDrawn(seq, drawnAt);
  }

  /** A new connection starts with new sequence numbers. */
  reset(): void {
    this.latency.reset();
    this.responses.reset();
    this.predictedSeq = 0;
  }
}
