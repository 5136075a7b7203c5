// Records the frames as MP4, or as WebM where the browser writes no MP4, as Firefox. The visible
// canvas belongs to the stream worker, so every frame is copied to another canvas, which the
// recorder captures.

import { Signal } from "../common/signal.ts";
import type { Viewer } from "../session/viewer.ts";

const bitsPerSecond = 8_000_000;
const types = [
  "video/mp4;codecs=avc1.640028",
  "video/mp4;codecs=avc1.42e01e",
  "video/mp4;codecs=vp09.00.10.08",
  "video/webm;codecs=vp9",
  "video/webm;codecs=vp8",
  "video/webm",
];

interface Recording {
  video: Blob;
  /** Of the file's name. */
  extension: "mp4" | "webm";
}

export class Recorder {
  private readonly viewer: Viewer;
  private recorder: MediaRecorder | null = null;
  private readonly canvas = document.createElement("canvas");
  private readonly parts: Blob[] = [];
  private startedAt = 0;
  /** Seconds since the start, every second; null while nothing is recorded. */
  readonly seconds = new Signal<number | null>(null);
  private timer = 0;

  static get possible(): boolean {
    return typeof MediaRecorder === "function" && "captureStream" in HTMLCanvasElement.prototype;
  }

  constructor(viewer: Viewer) {
    this.viewer = viewer;
  }

  get running(): boolean {
    return this.recorder !== null;
  }

  async start(): Promise<void> {
    const first = await this.viewer.connection.copyFrame();
    if (!first) throw new Error("There is no frame to record yet");
    this.parts.length = 0;
    this.paint(first);
    const type = types.find((candidate) => MediaRecorder.isTypeSupported(candidate));
    const options = { mimeType: type, videoBitsPerSecond: bitsPerSecond };
    const recorder = new MediaRecorder(this.canvas.captureStream(), options);
    recorder.addEventListener("dataavailable", ({ data }) => this.parts.push(data));
    recorder.start(1000);
    this.recorder = recorder;
    this.startedAt = performance.now();
    this.seconds.set(0);
    this.timer = window.setInterval(() => {
      this.seconds.set(Math.floor((performance.now() - this.startedAt) / 1000));
    }, 1000);
    this.viewer.connection.onFrameCopy = (image) => this.paint(image);
  }

  /** Ends the recording and returns the file. */
  async stop(): Promise<Recording> {
    const { recorder } = this;
    clearInterval(this.timer);
    this.seconds.set(null);
    this.viewer.connection.onFrameCopy = null;
    this.recorder = null;
    if (!recorder) throw new Error("No recording is running");
    const stopped = new Promise((resolve) => recorder.addEventListener("stop", resolve));
    recorder.stop();
    await stopped;
    const extension = recorder.mimeType.startsWith("video/mp4") ? "mp4" : "webm";
    return { video: new Blob(this.parts, { type: recorder.mimeType }), extension };
  }

  private paint(image: ImageBitmap): void {
    // The size is fixed at the start: recorders do not support a change.
    if (!this.recorder) {
      // H.264 has even sizes.
      this.canvas.width = image.width & ~1;
      this.canvas.height = image.height & ~1;
    }
    const context = this.canvas.getContext("2d", { alpha: false });
    context?.drawImage(image, 0, 0, this.canvas.width, this.canvas.height);
    image.close();
  }
}
