// Decodes and draws the newest frame. A still picture that arrives while another is being decoded
// replaces any that still waits: what matters is the latest picture, not every picture.

import {
  Codec,
  FrameFlag,
  type FrameHeader,
  mimeType,
  parseFrameHeader,
} from "heliograph/frame_header.ts";
import { type ArrivedFrame, VideoFrames } from "./video_frames.ts";
import { type DrawnFrame, type Freshness, clockMs } from "./worker_messages.ts";

export interface FrameSink {
  /** Shows the picture and takes ownership of it. */
  draw(picture: ImageBitmap | VideoFrame, frame: DrawnFrame): void;
  /** Tells the server that a frame is dealt with, shown or skipped. */
  acknowledge(frameSeq: number, decodeUs: number, presentUs: number): void;
  /** A picture is lost; with one of a video all up to the next key picture. */
  failed(message: string, video: boolean): void;
}

export type Decode = (
  bytes: Uint8Array<ArrayBuffer>,
  type: string,
) => Promise<ImageBitmap | VideoFrame>;

export class FramePipeline {
  private readonly sink: FrameSink;
  private readonly decode: Decode;
  private readonly video: VideoFrames;
  /** So long a picture of the size that was asked for is waited for; then any is better than none. */
  private readonly sizePatienceMs: number;
  private waiting: ArrivedFrame | null = null;
  private busy = false;
  private held = false;
  private fresh: Freshness = { oldestRev: 0 };
  private newestDrawn = 0;
  /** The newest picture of another size, and when it is shown for want of a better one. */
  private aside: ArrivedFrame | null = null;
  private asideTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(sink: FrameSink, decode: Decode, sizePatienceMs = 10_000) {
    this.sizePatienceMs = sizePatienceMs;
    this.sink = sink;
    this.decode = decode;
    this.video = new VideoFrames(
      {
        decoded: (picture, frame, startedAt) => this.present(picture, frame, startedAt),
        skipped: (frame) => this.skip(frame),
        failed: (message) => sink.failed(`the video could not be decoded: ${message}`, true),
      },
      clockMs,
    );
  }

  /** Takes one binary message from the socket. */
  push(message: ArrayBuffer): void {
    let header: FrameHeader;
    try {
      header = parseFrameHeader(message);
    } catch (error) {
      this.sink.failed((error as Error).message, false);
      return;
    }
    const frame = { header, message, receivedAt: clockMs() };
    if (header.codec === Codec.h264) {
      this.video.push(frame);
      return;
    }
    if (!this.held && this.hasOtherSize(header)) {
      this.setAside(frame);
      return;
    }
    if (header.stateRev < this.fresh.oldestRev) {
      this.skip(frame);
      return;
    }
    if (this.waiting) this.skip(this.waiting);
    this.waiting = frame;
    if (!this.busy && !this.held) void this.run();
  }

  /** Keeps what arrives from being shown, until it is known whether it is wanted. */
  hold(): void {
    this.held = true;
  }

  /** Goes on showing, but nothing older than this. */
  release(from: Freshness): void {
    if (!this.held) return;
    this.held = false;
    this.fresh = from;
    this.asideTimer = setTimeout(() => this.showAside(), this.sizePatienceMs);
    const { waiting } = this;
    if (waiting && this.hasOtherSize(waiting.header)) {
      this.waiting = null;
      this.setAside(waiting);
    } else if (waiting && waiting.header.stateRev < from.oldestRev) {
      this.waiting = null;
      this.skip(waiting);
    }
    if (!this.busy) void this.run();
  }

  /** Forgets what is left of a connection that is gone. */
  clear(): void {
    this.waiting = null;
    this.aside = null;
    clearTimeout(this.asideTimer);
    this.fresh = { oldestRev: 0 };
    this.newestDrawn = 0;
    this.video.clear();
  }

  private async run(): Promise<void> {
    this.busy = true;
    while (this.waiting && !this.held) {
      const frame = this.waiting;
      this.waiting = null;
      await this.show(frame);
    }
    this.busy = false;
  }

  private async show(frame: ArrivedFrame): Promise<void> {
    const { header, message } = frame;
    const type = mimeType(header.codec);
    if (!type) {
      this.sink.failed(`the server sent a picture in codec ${header.codec}`, false);
      this.skip(frame);
      return;
    }
    const startedAt = clockMs();
    try {
      const picture = await this.decode(new Uint8Array(message, header.headerBytes), type);
      this.present(picture, frame, startedAt);
    } catch {
      this.sink.failed(`it could not be decoded as ${type}`, false);
      this.skip(frame);
    }
  }

  private present(
    picture: ImageBitmap | VideoFrame,
    { header, message, receivedAt }: ArrivedFrame,
    startedAt: number,
  ): void {
    const { fresh, held, newestDrawn } = this;
    const unwanted = held || this.hasOtherSize(header) || header.stateRev < fresh.oldestRev;
    if (unwanted || header.frameSeq < newestDrawn) {
      picture.close();
      this.sink.acknowledge(header.frameSeq, 0, 0);
      return;
    }
    this.newestDrawn = header.frameSeq;
    this.fresh.size = undefined;
    const decodedAt = clockMs();
    this.sink.draw(picture, {
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
    });
    const decodeUs = Math.round((decodedAt - startedAt) * 1000);
    const presentUs = Math.round((clockMs() - receivedAt) * 1000);
    this.sink.acknowledge(header.frameSeq, decodeUs, presentUs);
  }

  private hasOtherSize({ fullWidth, fullHeight }: FrameHeader): boolean {
    const { size } = this.fresh;
    return size !== undefined && (fullWidth !== size.width || fullHeight !== size.height);
  }

  private setAside(frame: ArrivedFrame): void {
    this.skip(frame);
    this.aside = frame;
  }

  private showAside(): void {
    const frame = this.aside;
    this.aside = null;
    this.fresh.size = undefined;
    if (!frame || this.held || frame.header.frameSeq < this.newestDrawn) return;
    this.waiting ??= frame;
    if (!this.busy) void this.run();
  }

  private skip({ header }: ArrivedFrame): void {
    this.sink.acknowledge(header.frameSeq, 0, 0);
  }
}

/** The fastest decoder of still pictures this browser has. ImageDecoder reads them where they lie. */
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
