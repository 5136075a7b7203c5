// Decodes and draws the newest frame. A still picture that arrives while another is being decoded
// replaces any that still waits: what matters is the latest picture, not every picture.

import { Codec, type FrameHeader, mimeType, parseFrameHeader } from "heliograph/frame_header.ts";
import { type ArrivedFrame, VideoFrames } from "./video_frames.ts";
import { type DrawnFrame, clockMs } from "./worker_messages.ts";

export interface FrameSink {
  /** Shows the picture and takes ownership of it. */
  draw(picture: ImageBitmap | VideoFrame, frame: DrawnFrame): void;
  /** Tells the server that a frame is dealt with, shown or skipped. */
  acknowledge(frameSeq: number, decodeUs: number, presentUs: number): void;
  failed(message: string): void;
}

export type Decode = (
  bytes: Uint8Array<ArrayBuffer>,
  type: string,
) => Promise<ImageBitmap | VideoFrame>;

export class FramePipeline {
  private readonly sink: FrameSink;
  private readonly decode: Decode;
  private readonly video: VideoFrames;
  private waiting: ArrivedFrame | null = null;
  private busy = false;
  private held = false;
  private oldestRev = 0;
  private newestDrawn = 0;

  constructor(sink: FrameSink, decode: Decode) {
    this.sink = sink;
    this.decode = decode;
    this.video = new VideoFrames(
      {
        decoded: (picture, frame, startedAt) => this.present(picture, frame, startedAt),
        skipped: (frame) => this.skip(frame),
        failed: (message) => sink.failed(`the video could not be decoded: ${message}`),
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
      this.sink.failed((error as Error).message);
      return;
    }
    const frame = { header, message, receivedAt: clockMs() };
    if (header.codec === Codec.h264) {
      this.video.push(frame);
      return;
    }
    if (header.stateRev < this.oldestRev) {
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

  /** Goes on showing, but nothing that shows an older state of the session than this. */
  release(oldestRev: number): void {
    if (!this.held) return;
    this.held = false;
    this.oldestRev = oldestRev;
    if (this.waiting && this.waiting.header.stateRev < oldestRev) {
      this.skip(this.waiting);
      this.waiting = null;
    }
    if (!this.busy) void this.run();
  }

  /** Forgets what is left of a connection that is gone. */
  clear(): void {
    this.waiting = null;
    this.oldestRev = 0;
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
      this.sink.failed(`the server sent a picture in codec ${header.codec}`);
      return;
    }
    const startedAt = clockMs();
    try {
      const picture = await this.decode(new Uint8Array(message, header.headerBytes), type);
      this.present(picture, frame, startedAt);
    } catch {
      this.sink.failed(`it could not be decoded as ${type}`);
      this.skip(frame);
    }
  }

  private present(
    picture: ImageBitmap | VideoFrame,
    { header, message, receivedAt }: ArrivedFrame,
    startedAt: number,
  ): void {
    const unwanted = this.held || header.stateRev < this.oldestRev;
    if (unwanted || header.frameSeq < this.newestDrawn) {
      picture.close();
      this.sink.acknowledge(header.frameSeq, 0, 0);
      return;
    }
    this.newestDrawn = header.frameSeq;
    const decodedAt = clockMs();
    this.sink.draw(picture, {
      frameSeq: header.frameSeq,
      inputSeqEcho: header.inputSeqEcho,
      renderId: header.renderId,
      codec: header.codec,
      width: header.width,
      height: header.height,
      samples: header.sampleCount,
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
