// Shows frames and, until the next one comes, the newest as seen from the camera that the page has
// moved on to: the view follows the pointer, however long the server takes. A frame that shows the
// page's newest camera is drawn as it is.

import type { FrameDepth } from "heliograph/frame_depth.ts";
import type { CanvasPainter } from "./canvas_painter.ts";
import { Reprojection } from "./reprojection.ts";
import type { DrawnFrame, PredictedCamera } from "./worker_messages.ts";

/** A camera that no frame shows for so long has been refused by the server. */
const refusedAfterMs = 10_000;

const shortDrawMs = 8;
const slowDrawMs = 20;
const longestRestMs = 100;

type ShownFrame = Pick<DrawnFrame, "inputSeqEcho" | "width" | "height">;

interface PredictedViewEvents {
  /** An image was drawn that shows the camera.set of this number before the server does. */
  predicted(seq: number): void;
  /** This browser cannot reproject. */
  unsupported(): void;
}

export class PredictedView {
  private readonly painter: CanvasPainter;
  private readonly events: PredictedViewEvents;
  private reprojection: Reprojection | null = null;
  private camera: PredictedCamera | null = null;
  private predictedAt = 0;
  private scheduled = false;
  private restMs = 0;
  /** Whether frames are reprojected coarsely from the next one on. */
  private coarse = false;
  private newest: ShownFrame | null = null;
  /** The frame on the canvas, with its depth as soon as that is read. */
  private placed: ShownFrame | null = null;
  private depth: FrameDepth | null = null;
  /** Whether the reprojection has that frame. */
  private taken = false;
  /** Whether the canvas shows it from another camera. */
  private reprojected = false;

  constructor(painter: CanvasPainter, events: PredictedViewEvents) {
    this.painter = painter;
    this.events = events;
  }

  /** Takes ownership of the image. False if a newer frame has come before it was shown. */
  async show(
    image: ImageBitmap | VideoFrame,
    frame: ShownFrame,
    depth: Promise<FrameDepth | null>,
  ): Promise<boolean> {
    this.newest = frame;
    const follows = this.isAheadOf(frame) && this.depth !== null;
    if (!follows) this.place(image, frame);
    // Drawn before its depth is known, the frame would jump back for a moment.
    const read = await depth.catch(() => null);
    if (follows && this.newest !== frame) {
      image.close();
      return false;
    }
    if (follows) this.place(image, frame);
    if (this.placed === frame) {
      this.depth = read;
      if (read) this.prepare();
      this.redraw();
    }
    return true;
  }

  /** The page has moved the camera; null: it was moved by others, so nothing is known. */
  predict(camera: PredictedCamera | null): void {
    this.camera = camera;
    this.predictedAt = performance.now();
    if (camera) this.schedule();
    else this.redraw();
  }

  /** A copy of the newest frame as the server sent it; null before the first. */
  async copy(): Promise<ImageBitmap | null> {
    if (!this.reprojected) return this.painter.copy();
    this.overlay();
    const copied = this.painter.copy();
    this.redraw();
    return copied;
  }

  private isAheadOf(frame: ShownFrame): boolean {
    const current = performance.now() - this.predictedAt < refusedAfterMs;
    return this.camera !== null && current && frame.inputSeqEcho < this.camera.seq;
  }

  private place(image: ImageBitmap | VideoFrame, frame: ShownFrame): void {
    this.painter.draw(image, frame.width, frame.height);
    this.placed = frame;
    this.depth = null;
    this.taken = false;
    this.reprojected = false;
  }

  /**
   * Of several cameras between two images of the screen the newest is drawn. Where drawing takes
   * long, half of the time is left to the frames, and to a server on the same processor.
   */
  private schedule(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    const run = (): void => {
      this.scheduled = false;
      const start = performance.now();
      this.redraw();
      const drawMs = performance.now() - start;
      this.restMs = Math.min(longestRestMs, drawMs);
      // A coarse image takes about a fifth of the time.
      this.coarse = drawMs > slowDrawMs || (this.coarse && drawMs > slowDrawMs / 8);
    };
    const next = (): void => {
      if (typeof requestAnimationFrame === "function") requestAnimationFrame(run);
      else run();
    };
    if (this.restMs > shortDrawMs) setTimeout(next, this.restMs);
    else next();
  }

  private redraw(): void {
    const { camera, placed, depth } = this;
    if (!placed || !depth) return;
    if (camera && this.isAheadOf(placed)) {
      if (!this.prepare()) return;
      if (!this.taken) this.reprojection?.take(this.painter.canvas, depth, this.coarse);
      this.taken = true;
      this.reprojected = true;
      this.overlay(camera);
      this.events.predicted(camera.seq);
    } else if (this.reprojected) {
      this.overlay();
      this.reprojected = false;
    }
  }

  private overlay(camera?: PredictedCamera): void {
    if (!this.reprojection) return;
    this.reprojection.draw(camera);
    this.painter.overlay(this.reprojection.canvas);
  }

  /** Made with the first frame that has depth, so that the first movement does not wait for it. */
  private prepare(): boolean {
    if (this.reprojection?.usable === false) this.reprojection = null;
    this.reprojection ??= Reprojection.create();
    if (this.reprojection) return true;
    this.depth = null;
    this.events.unsupported();
    return false;
  }
}
