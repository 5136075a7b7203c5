// Pictures of a video stream (H.264, Annex B). Each builds on the one before, so that all are
// decoded in turn; after a loss everything up to the next key picture is useless.

import { codecString } from "./annex_b.ts";
import { type FrameHeader, FrameFlag } from "heliograph/frame_header.ts";

/** Constrained baseline, level 4.2: no picture waits for a later one. */
export const videoConfig: VideoDecoderConfig = {
  codec: "avc1.42E02A",
  optimizeForLatency: true,
};

export interface ArrivedFrame {
  header: FrameHeader;
  message: ArrayBuffer;
  receivedAt: number;
}

export interface VideoSink {
  /** Takes ownership of the picture. */
  decoded(picture: VideoFrame, frame: ArrivedFrame, startedAt: number): void;
  /** This frame will not be shown. */
  skipped(frame: ArrivedFrame): void;
  failed(message: string): void;
}

export class VideoFrames {
  private readonly sink: VideoSink;
  private readonly clock: () => number;
  private decoder: VideoDecoder | null = null;
  private codec = "";
  private readonly waiting = new Map<number, { frame: ArrivedFrame; startedAt: number }>();

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
    this.waiting.set(timestamp, { frame, startedAt: this.clock() });
    try {
      this.decoder.decode(new EncodedVideoChunk({ type: key ? "key" : "delta", timestamp, data }));
    } catch (error) {
      // A key picture that is none is found out at once, everything else by the decoder's own word.
      this.broke(this.decoder, error as Error);
    }
  }

  /** Forgets a stream that has ended; the next begins with a key picture. */
  clear(): void {
    this.waiting.clear();
    if (this.decoder && this.decoder.state !== "closed") this.decoder.close();
    this.decoder = null;
  }

  /** What is under way is lost, and all up to the next key picture. */
  private broke(decoder: VideoDecoder, error: Error): void {
    const lost = [...this.waiting.values()];
    this.waiting.clear();
    if (this.decoder === decoder) this.decoder = null;
    if (decoder.state !== "closed") decoder.close();
    lost.forEach(({ frame }) => this.sink.skipped(frame));
    this.sink.failed(error.message);
  }

  /** Sets the decoder up, unless it already takes such a stream. */
  private open(codec: string): void {
    if (this.decoder?.state === "configured" && this.codec === codec) return;
    if (this.decoder?.state === "configured") {
      this.codec = codec;
      this.decoder.configure({ ...videoConfig, codec });
      return;
    }
    this.codec = codec;
    const decoder = new VideoDecoder({
      output: (picture) => {
        const entry = this.waiting.get(picture.timestamp);
        this.waiting.delete(picture.timestamp);
        if (entry) this.sink.decoded(picture, entry.frame, entry.startedAt);
        else picture.close();
      },
      error: (error) => this.broke(decoder, error),
    });
    decoder.configure({ ...videoConfig, codec });
    this.decoder = decoder;
  }
}
