// What this page requests of its stream: size, quality, codec, and a restart after decoding errors.

import type { Hello, StreamConfigureParams, StreamSettings } from "heliograph/messages.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { preferences } from "../common/preferences.ts";
import { Signal } from "../common/signal.ts";

export interface FrameSize {
  width: number;
  height: number;
}

/** More decoding errors than this, with fewer good frames in between, switch to JPEG. */
const maxVideoErrors = 3;
const stableFrames = 60;

interface StreamHost {
  /** Whether this page may change the frame size, which all viewers share. */
  mayResize(): boolean;
  report(error: unknown): void;
  inform(sentence: string): void;
}

export class StreamRequests {
  /** The settings in effect, as last confirmed by the server. */
  readonly settings = new Signal<StreamSettings | null>(null);
  /** The frame size that suits the view and this server. */
  chooseSize: (hello: Hello) => FrameSize = () => ({ width: 640, height: 360 });
  private readonly rpc: RpcPeer;
  private readonly host: StreamHost;
  private hello: Hello | null = null;
  private sentSize: FrameSize | null = null;
  /** Choices that outlive the connection. */
  private preferred: StreamConfigureParams = {};
  private videoErrors = 0;
  private framesSinceError = 0;
  /** The server streams from its hello on, so an error can come before the first request. */
  private failedBeforeBegin = false;

  constructor(rpc: RpcPeer, host: StreamHost) {
    this.rpc = rpc;
    this.host = host;
  }

  /** Sends all choices over a new connection. `startPaused` waits for `resume`. */
  async begin(hello: Hello, startPaused: boolean): Promise<void> {
    this.hello = hello;
    this.sentSize = null;
    const restart = this.failedBeforeBegin;
    this.failedBeforeBegin = false;
    const codec = preferences.text("codec", isLocal() ? "jpeg" : "h264");
    const choice = { codec: codec as StreamSettings["codec"] };
    const coded = hello.codecs.length > 1 && hello.codecs.includes(codec) ? choice : {};
    const paused = startPaused || restart ? { paused: true } : {};
    const depth = this.preferred.depth ?? true;
    await this.configure({ ...this.preferred, ...this.size(), ...coded, ...paused, depth });
    if (restart && !startPaused) await this.resume();
  }

  end(): void {
    this.hello = null;
    this.videoErrors = 0;
    this.failedBeforeBegin = false;
  }

  /** Starts the stream after a paused `begin`, unless the page is hidden. */
  async resume(): Promise<void> {
    await this.configure({ paused: this.preferred.paused ?? false });
  }

  /** Changes the stream, also for later connections. */
  request(change: StreamConfigureParams): void {
    this.preferred = { ...this.preferred, ...change };
    void this.configure(change);
  }

  /** In another session the size is to be requested again. */
  sessionChanged(): void {
    this.sentSize = null;
    this.updateSize();
  }

  /** Requests another frame size if the view, the screen or the choice has changed. */
  updateSize(): void {
    void this.configure(this.size());
  }

  /** Frames have this size now; another viewer may have chosen it. */
  onFrameSize({ width, height }: Partial<FrameSize>): void {
    const now = this.settings.value;
    if (!now || width === undefined || height === undefined) return;
    if (now.width !== width || now.height !== height) this.settings.set({ ...now, width, height });
  }

  /** The frame size that this page has requested; undefined if it has not. */
  get requestedSize(): FrameSize | undefined {
    const now = this.settings.value;
    return this.sentSize && now ? { width: now.width, height: now.height } : undefined;
  }

  /** A video frame could not be decoded: the next ones depend on it, so the video restarts. */
  onVideoError(): void {
    if (this.preferred.paused) return;
    this.videoErrors = this.framesSinceError >= stableFrames ? 1 : this.videoErrors + 1;
    this.framesSinceError = 0;
    if (this.videoErrors > maxVideoErrors) {
      this.videoErrors = 0;
      this.host.inform("Video decoding fails too often. The stream uses JPEG now.");
      this.request({ codec: "jpeg" });
    } else if (!this.hello) {
      this.failedBeforeBegin = true;
    } else {
      // A stream that resumes starts with a key frame.
      void this.configure({ paused: true }).then(() => this.resume());
    }
  }

  /** A video frame was drawn. */
  onVideoFrame(): void {
    this.framesSinceError += 1;
  }

  /** The size to request; empty where it is unchanged or other viewers choose it. */
  private size(): Partial<FrameSize> {
    if (!this.hello) return {};
    if (!this.host.mayResize()) {
      this.sentSize = null; // another viewer may change it
      return {};
    }
    const size = this.chooseSize(this.hello);
    const before = this.sentSize;
    if (before && before.width === size.width && before.height === size.height) return {};
    this.sentSize = size;
    return size;
  }

  private async configure(change: StreamConfigureParams): Promise<void> {
    if (Object.keys(change).length === 0 || !this.hello) return;
    try {
      this.settings.set(await this.rpc.request("stream.configure", change));
    } catch (error) {
      this.host.report(error);
    }
  }
}

/** JPEG is sharper in motion; over a network, bandwidth matters more. */
function isLocal(): boolean {
  return ["localhost", "127.0.0.1", "[::1]"].includes(location.hostname);
}
