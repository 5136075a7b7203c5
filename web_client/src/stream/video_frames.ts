// Decodes a video stream (H.264, Annex B). Every frame depends on the one before: all are decoded
// in order, and after a loss the frames up to the next key frame are skipped.

import type { FrameDepth } from "heliograph/frame_depth.ts";
import { type FrameHeader, FrameFlag } from "heliograph/frame_header.ts";
import { codecString } from "./annex_b.ts";

/** Constrained baseline, level 4.2: no frame depends on a later one. */
export const videoConfig: VideoDecoderConfig = {
  codec: "avc1.42E02A",
  optimizeForLatency: true,
};

export interface ArrivedFrame {
  header: FrameHeader;
  message: ArrayBuffer;
  receivedAt: number;
  depth: Promise<FrameDepth | null>;
}

interface VideoSink {
  /** Takes ownership of the image. */
  decoded(image: VideoFrame, frame: ArrivedFrame, startedAt: number): void;
  /** This frame is not shown. */
  skipped(frame: ArrivedFrame): void;
  failed(message: string): void;
}

export class VideoFrames {
  private readonly sink: VideoSink;
  private readonly clock: () => number;
  private decoder: VideoDecoder | null = null;
  private codec = "";
  private readonly pending = new Map<number, { frame: ArrivedFrame; startedAt: number }>();

  constructor(sink: VideoSink, clock: () => number) {
    this.sink = sink;
    this.clock = clock;
  }

  push(frame: ArrivedFrame): void {
    const key = (frame.header.flags & FrameFlag.key) !== 0;
    const data = new Uint8Array(frame.message, frame.header.headerBytes);
    if (key) this.open(codecString(data) ?? videoConfig.codec);
    if (!this.decoder || this.decoder.state !== "configured") {
      this.sink.skipped(frame);
      return;
    }
    const timestamp = frame.header.frameSeq;
    this.pending.set(timestamp, { frame, startedAt: this.clock() });
    try {
      this.decoder.decode(new EncodedVideoChunk({ type: key ? "key" : "delta", timestamp, data }));
    } catch (error) {
      // Thrown for an invalid key frame; all other errors go to the decoder's callback.
      this.fail(this.decoder, error as Error);
    }
  }

  /** Discards a stream that has ended; the next one starts with a key frame. */
  clear(): void {
    this.pending.clear();
    if (this.decoder && this.decoder.state !== "closed") this.decoder.close();
    this.decoder = null;
  }

  /** Pending frames are lost, and all others up to the next key frame. */
  private fail(decoder: VideoDecoder, error: Error): void {
    const lost = [...this.pending.values()];
    this.pending.clear();
    if (this.decoder === decoder) this.decoder = null;
    if (decoder.state !== "closed") decoder.close();
    lost.forEach(({ frame }) => this.sink.skipped(frame));
    this.sink.failed(error.message);
  }

  /** Configures the decoder, unless it already decodes this codec. */
  private open(codec: string): void {
    if (this.decoder?.state === "configured" && this.codec === codec) return;
    if (this.decoder?.state === "configured") {
      this.codec = codec;
      this.decoder.configure({ ...videoConfig, codec });
      return;
    }
    this.codec = codec;
    const decoder = new VideoDecoder({
      output: (image) => {
        const entry = this.pending.get(image.timestamp);
        this.pending.delete(image.timestamp);
        if (entry) this.sink.decoded(image, entry.frame, entry.startedAt);
        else image.close();
      },
      error: (error) => this.fail(decoder, error),
    });
    decoder.configure({ ...videoConfig, codec });
    this.decoder = decoder;
  }
}
