// Decodes and draws the newest frame. An image that arrives while another is being decoded replaces
// the queued one: the latest frame matters, not every frame.

import { type FrameDepth, readFrameDepth } from "heliograph/frame_depth.ts";
import {
  Codec,
  FrameFlag,
  type FrameHeader,
  mimeType,
  parseFrameHeader,
} from "heliograph/frame_header.ts";
import { type ArrivedFrame, VideoFrames } from "./video_frames.ts";
import { type DrawnFrame, type FrameRequirement, clockMs } from "./worker_messages.ts";

export interface FrameSink {
  /** Draws the image and takes ownership of it; `depth` is that of the frame, if it has one. */
  draw(
    image: ImageBitmap | VideoFrame,
    frame: DrawnFrame,
    depth: Promise<FrameDepth | null>,
  ): void;
  /** Acknowledges a frame to the server, whether drawn or skipped. */
  acknowledge(frameSeq: number, decodeUs: number, presentUs: number): void;
  /** A frame is lost; with `video`, all frames up to the next key frame as well. */
  failed(message: string, video: boolean): void;
}

type Decode = (bytes: Uint8Array<ArrayBuffer>, type: string) => Promise<ImageBitmap | VideoFrame>;

export class FramePipeline {
  private readonly sink: FrameSink;
  private readonly decode: Decode;
  private readonly video: VideoFrames;
  /** How long to wait for a frame of the requested size before any size is shown. */
  private readonly sizeTimeoutMs: number;
  private queued: ArrivedFrame | null = null;
  private busy = false;
  private held = false;
  private required: FrameRequirement = { oldestRev: 0 };
  private newestDrawn = 0;
  /** The newest frame of another size, shown when the timer expires. */
  private otherSize: ArrivedFrame | null = null;
  private otherSizeTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(sink: FrameSink, decode: Decode, sizeTimeoutMs = 10_000) {
    this.sizeTimeoutMs = sizeTimeoutMs;
    this.sink = sink;
    this.decode = decode;
    this.video = new VideoFrames(
      {
        decoded: (image, frame, startedAt) => this.present(image, frame, startedAt),
        skipped: (frame) => this.skip(frame),
        failed: (message) => sink.failed(`the video could not be decoded: ${message}`, true),
      },
      clockMs,
    );
  }

  /** Takes one binary message of the WebSocket. */
  push(message: ArrayBuffer): void {
    let header: FrameHeader;
    try {
      header = parseFrameHeader(message);
    } catch (error) {
      this.sink.failed((error as Error).message, false);
      return;
    }
    const depth = readFrameDepth(message, header);
    depth.catch(() => {}); // PredictedView handles it, if it shows the frame
    const frame = { header, message, receivedAt: clockMs(), depth };
    if (header.codec === Codec.h264) {
      this.video.push(frame);
      return;
    }
    if (!this.held && this.hasOtherSize(header)) {
      this.keepOtherSize(frame);
      return;
    }
    if (header.stateRev < this.required.oldestRev) {
      this.skip(frame);
      return;
    }
    if (this.queued) this.skip(this.queued);
    this.queued = frame;
    if (!this.busy && !this.held) void this.run();
  }

  /** Shows no frames until `release`. */
  hold(): void {
    this.held = true;
  }

  /** Shows frames again, but none that is older than required. */
  release(required: FrameRequirement): void {
    if (!this.held) return;
    this.held = false;
    this.required = required;
    this.otherSizeTimer = setTimeout(() => this.showOtherSize(), this.sizeTimeoutMs);
    const { queued } = this;
    if (queued && this.hasOtherSize(queued.header)) {
      this.queued = null;
      this.keepOtherSize(queued);
    } else if (queued && queued.header.stateRev < required.oldestRev) {
      this.queued = null;
      this.skip(queued);
    }
    if (!this.busy) void this.run();
  }

  /** Discards the frames of a lost connection. */
  clear(): void {
    this.queued = null;
    this.otherSize = null;
    clearTimeout(this.otherSizeTimer);
    this.required = { oldestRev: 0 };
    this.newestDrawn = 0;
    this.video.clear();
  }

  private async run(): Promise<void> {
    this.busy = true;
    while (this.queued && !this.held) {
      const frame = this.queued;
      this.queued = null;
      await this.show(frame);
    }
    this.busy = false;
  }

  private async show(frame: ArrivedFrame): Promise<void> {
    const { header, message } = frame;
    const type = mimeType(header.codec);
    if (!type) {
      this.sink.failed(`unknown codec ${header.codec}`, false);
      this.skip(frame);
      return;
    }
    const startedAt = clockMs();
    try {
      const image = await this.decode(new Uint8Array(message, header.headerBytes), type);
      this.present(image, frame, startedAt);
    } catch {
      this.sink.failed(`it could not be decoded as ${type}`, false);
      this.skip(frame);
    }
  }

  private present(
    image: ImageBitmap | VideoFrame,
    { header, message, receivedAt, depth }: ArrivedFrame,
    startedAt: number,
  ): void {
    const { required, held, newestDrawn } = this;
    const skipped = held || this.hasOtherSize(header) || header.stateRev < required.oldestRev;
    if (skipped || header.frameSeq < newestDrawn) {
      image.close();
      this.sink.acknowledge(header.frameSeq, 0, 0);
      return;
    }
    this.newestDrawn = header.frameSeq;
    this.required.size = undefined;
    const decodedAt = clockMs();
    const drawn: DrawnFrame = {
      frameSeq: header.frameSeq,
      inputSeqEcho: header.inputSeqEcho,
      renderId: header.renderId,
      codec: header.codec,
      width: header.width,
      height: header.height,
      samples: header.sampleCount,
      final: (header.flags & FrameFlag.final) !== 0,
      stateRev: header.stateRev,
      quality: header.quality,
      bytes: message.byteLength,
      renderMs: header.renderUs / 1000,
      encodeMs: header.encodeUs / 1000,
      decodeMs: decodedAt - startedAt,
      receivedAt,
      drawnAt: clockMs(),
    };
    this.sink.draw(image, drawn, depth);
    const decodeUs = Math.round((decodedAt - startedAt) * 1000);
    const presentUs = Math.round((clockMs() - receivedAt) * 1000);
    this.sink.acknowledge(header.frameSeq, decodeUs, presentUs);
  }

  private hasOtherSize({ fullWidth, fullHeight }: FrameHeader): boolean {
    const { size } = this.required;
    return size !== undefined && (fullWidth !== size.width || fullHeight !== size.height);
  }

  private keepOtherSize(frame: ArrivedFrame): void {
    this.skip(frame);
    this.otherSize = frame;
  }

  private showOtherSize(): void {
    const frame = this.otherSize;
    this.otherSize = null;
    this.required.size = undefined;
    if (!frame || this.held || frame.header.frameSeq < this.newestDrawn) return;
    this.queued ??= frame;
    if (!this.busy) void this.run();
  }

  private skip({ header }: ArrivedFrame): void {
    this.sink.acknowledge(header.frameSeq, 0, 0);
  }
}

/** The fastest image decoder of this browser. ImageDecoder reads the data without a copy. */
export async function chooseDecoder(): Promise<Decode> {
  if ("ImageDecoder" in globalThis && (await ImageDecoder.isTypeSupported("image/jpeg"))) {
    return async (bytes, type) => {
      const decoder = new ImageDecoder({ data: bytes, type, colorSpaceConversion: "none" });
      try {
        return (await decoder.decode()).image;
      } finally {
        decoder.close();
      }
    };
  }
  return (bytes, type) =>
    createImageBitmap(new Blob([bytes], { type }), {
      colorSpaceConversion: "none",
      premultiplyAlpha: "none",
    });
}
