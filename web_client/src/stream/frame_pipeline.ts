// Decodes and draws the newest frame. A frame that arrives while another is being decoded
// replaces any that still waits: what matters is the latest picture, not every picture.

import { type FrameHeader, mimeType, parseFrameHeader } from "heliograph/frame_header.ts";
import { type DrawnFrame, clockMs } from "./worker_messages.ts";

interface Arrived {
  header: FrameHeader;
  message: ArrayBuffer;
  receivedAt: number;
}

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
  private waiting: Arrived | null = null;
  private busy = false;
  private held = false;
  private oldestRev = 0;

  constructor(sink: FrameSink, decode: Decode) {
    this.sink = sink;
    this.decode = decode;
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
    if (header.stateRev < this.oldestRev) {
      this.sink.acknowledge(header.frameSeq, 0, 0);
      return;
    }
    if (this.waiting) this.sink.acknowledge(this.waiting.header.frameSeq, 0, 0);
    this.waiting = { header, message, receivedAt: clockMs() };
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
      this.sink.acknowledge(this.waiting.header.frameSeq, 0, 0);
      this.waiting = null;
    }
    if (!this.busy) void this.run();
  }

  /** Forgets a waiting frame of a connection that is gone. */
  clear(): void {
    this.waiting = null;
    this.oldestRev = 0;
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

  private async show({ header, message, receivedAt }: Arrived): Promise<void> {
    const type = mimeType(header.codec);
    if (!type) {
      this.sink.failed(`the server sent a picture in codec ${header.codec}`);
      return;
    }
    const startedAt = clockMs();
    try {
      const picture = await this.decode(new Uint8Array(message, header.headerBytes), type);
      const decodedAt = clockMs();
      this.sink.draw(picture, {
        frameSeq: header.frameSeq,
        inputSeqEcho: header.inputSeqEcho,
        renderId: header.renderId,
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
    } catch {
      this.sink.failed(`it could not be decoded as ${type}`);
      this.sink.acknowledge(header.frameSeq, 0, 0);
    }
  }
}

/** The fastest decoder this browser has. ImageDecoder reads the bytes where they lie. */
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
