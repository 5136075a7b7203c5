// The connection to the server: opens it, sends hello, detects its loss and reconnects.

import { type Hello, ErrorCode, subprotocol } from "heliograph/messages.ts";
import { ChannelClosed, RpcError, RpcPeer } from "heliograph/rpc.ts";
import { participantName } from "../common/preferences.ts";
import { Signal } from "../common/signal.ts";
import { Backoff } from "./backoff.ts";
import { decodableCodecs } from "./codecs.ts";
import {
  type SessionOrigin,
  SessionAddress,
  mainSession,
  rendezvousRoute,
} from "./session_address.ts";
import type {
  DrawnFrame,
  FrameRequirement,
  FromWorker,
  PredictedCamera,
  ToWorker,
} from "./worker_messages.ts";

export type ConnectionState =
  | { kind: "connecting" }
  | { kind: "live"; hello: Hello }
  | { kind: "lost"; retryAt: number }
  /** The server answers HTTP, but WebSockets do not get through. */
  | { kind: "mjpeg_fallback"; retryAt: number }
  | { kind: "wrong_version"; detail: string }
  | { kind: "full"; retryAt: number }
  | { kind: "forbidden"; detail: string };

interface ConnectionEvents {
  /** Before each attempt to connect; may choose the session in the address. */
  prepare?(): Promise<void>;
  /** The requested session does not exist; true if another one is to be prepared. */
  sessionMissing?(): boolean;
  live(hello: Hello): Promise<void>;
  notification(method: string, params: unknown): void;
  drawn(frame: DrawnFrame): void;
  /** Only where the worker cannot draw: draws the image and takes ownership of it. */
  draw(image: ImageBitmap | VideoFrame, frame: DrawnFrame): void;
  /** An image was drawn that shows the page's input before a frame of the server does. */
  predicted?(seq: number, drawnAt: number): void;
  /** This browser cannot do that. */
  cannotPredict?(): void;
  warning(message: string): void;
  /** A frame was lost; with `video`, all frames that depend on it as well. */
  decodeFailed(message: string, video: boolean): void;
}

const closeCode = { policy: 1008, tryAgainLater: 1013, unauthorised: 4001, version: 4005 };
const stableAfterMs = 5000;
const rejectionsBeforeFallback = 2;
const aliveCheckMs = 15_000;
const aliveTimeoutMs = 10_000;
/** Read-only viewers cannot create a session, so they follow the others to a new server. */
const readOnlyDelayMs = 2000;

export class Connection {
  readonly state = new Signal<ConnectionState>({ kind: "connecting" });
  readonly rpc: RpcPeer;
  readonly address: SessionAddress;
  /** The session to reconnect to. On another server, it may get another name. */
  origin: SessionOrigin | null = null;
  private readonly worker: Worker;
  private readonly events: ConnectionEvents;
  private readonly backoff = new Backoff();
  private retryTimer = 0;
  private stableTimer = 0;
  private lastMessageAt = 0;
  private rejectedUpgrades = 0;
  private readOnly = false;
  private readonly disposal = new AbortController();
  private readonly aliveTimer: number;
  private lastCopyId = 0;
  private readonly copies = new Map<number, (image: ImageBitmap | null) => void>();
  private copyListener: ((image: ImageBitmap) => void) | null = null;

  constructor(
    base: string,
    canvas: OffscreenCanvas | null,
    events: ConnectionEvents,
    address = SessionAddress.ofPage(base),
  ) {
    this.address = address;
    this.events = events;
    this.worker = new Worker(new URL("worker.js", base), { name: "stream" });
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.receive(data);
    this.worker.onerror = () => this.events.warning("The stream worker did not start");
    this.rpc = new RpcPeer(
      (text) => this.post({ kind: "send", text }),
      (method, params) => this.events.notification(method, params),
    );
    if (canvas) this.post({ kind: "canvas", canvas }, [canvas]);
    const { signal } = this.disposal;
    addEventListener("online", () => this.retryNow(), { signal });
    const onVisible = (): void => {
      if (!document.hidden) this.retryNow();
    };
    document.addEventListener("visibilitychange", onVisible, { signal });
    this.aliveTimer = window.setInterval(() => void this.checkAlive(), aliveCheckMs);
  }

  /** Closes the connection permanently. */
  dispose(): void {
    this.disposal.abort();
    clearInterval(this.aliveTimer);
    clearTimeout(this.retryTimer);
    clearTimeout(this.stableTimer);
    this.rpc.close();
    this.worker.terminate();
  }

  /** Sends the participant's name again. */
  updateName(): void {
    if (this.state.value.kind === "live") void this.requestHello().catch(() => {});
  }

  open(): void {
    clearTimeout(this.retryTimer);
    this.retryTimer = 0;
    void this.prepare().then(() => {
      const url = this.address.url("ws");
      url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
      this.post({ kind: "open", url: url.href, subprotocol });
    });
  }

  /** Leaves the session and connects to the one in the address. */
  reopen(): void {
    this.origin = null;
    clearTimeout(this.stableTimer);
    this.stop({ kind: "connecting" });
    this.open();
  }

  private async prepare(): Promise<void> {
    await this.chooseRoute();
    await this.events.prepare?.();
  }

  /** On another server instance, all viewers of the previous session choose the same route. */
  private async chooseRoute(): Promise<void> {
    const { origin, address } = this;
    if (!origin) return;
    const hello = await address.fetchHello();
    if (!hello || hello.instance === origin.instance) return;
    address.route = rendezvousRoute(origin);
    if (this.readOnly) await new Promise((resolve) => setTimeout(resolve, readOnlyDelayMs));
  }

  /** Puts the session into the page's URL, so that a reload leads there. */
  async persistRoute({ instance, session }: SessionOrigin): Promise<void> {
    const { address } = this;
    address.session = session;
    if (session === mainSession && (await address.fetchHello(null))?.instance === instance) {
      address.route = null; // the page's plain URL leads to this server
    }
    history.replaceState(history.state, "", address.pageUrl(location.href));
  }

  /** A copy of the current frame; null before the first. */
  copyFrame(): Promise<ImageBitmap | null> {
    const id = ++this.lastCopyId;
    return new Promise((resolve) => {
      this.copies.set(id, resolve);
      this.post({ kind: "copy", id });
    });
  }

  /** Sends a copy of every frame to the listener, which must close it; null stops it. */
  set onFrameCopy(listener: ((image: ImageBitmap) => void) | null) {
    this.copyListener = listener;
    this.post({ kind: "copy_frames", enabled: listener !== null });
  }

  /** Shows the newest frame from this camera until a frame shows it; null: no longer. */
  predict(camera: PredictedCamera | null): void {
    this.post({ kind: "predict", camera });
  }

  /** Holds frames back until `release`, which shows those that are new enough. */
  hold(): void {
    this.post({ kind: "hold" });
  }

  release(required: FrameRequirement): void {
    this.post({ kind: "release", required });
  }

  /** Ends the delay before the next attempt, after a click or when the network is back. */
  retryNow(): void {
    if (this.retryTimer) this.open();
  }

  private post(message: ToWorker, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }

  private receive(message: FromWorker): void {
    this.lastMessageAt = performance.now();
    switch (message.kind) {
      case "opened":
        this.rejectedUpgrades = 0;
        this.rpc.open();
        void this.startSession(message.subprotocol);
        break;
      case "closed":
        void this.closed(message.code, message.reason, message.wasOpen);
        break;
      case "text":
        this.rpc.receive(message.text);
        break;
      case "drawn":
        this.events.drawn(message.frame);
        break;
      case "decoded":
        this.events.draw(message.image, message.frame);
        this.events.drawn(message.frame);
        break;
      case "predicted":
        this.events.predicted?.(message.seq, message.drawnAt);
        break;
      case "cannot_predict":
        this.events.cannotPredict?.();
        break;
      case "copied":
        this.onCopy(message.id, message.image);
        break;
      case "decode_failed":
        this.events.decodeFailed(message.message, message.video);
        break;
    }
  }

  private onCopy(id: number, image: ImageBitmap | null): void {
    const resolve = this.copies.get(id);
    this.copies.delete(id);
    if (resolve) resolve(image);
    else if (image && this.copyListener) this.copyListener(image);
    else image?.close();
  }

  private async startSession(offered: string): Promise<void> {
    if (offered !== subprotocol) {
      this.stop({ kind: "wrong_version", detail: offered || "no known version" });
      return;
    }
    try {
      const hello = await this.requestHello();
      if (hello.protocol !== subprotocol) {
        this.stop({ kind: "wrong_version", detail: hello.protocol });
        return;
      }
      this.readOnly = hello.role === "view";
      await this.events.live(hello);
      this.state.set({ kind: "live", hello });
      clearTimeout(this.stableTimer);
      this.stableTimer = window.setTimeout(() => this.backoff.reset(), stableAfterMs);
    } catch (error) {
      if (error instanceof ChannelClosed) return;
      this.onHelloError(error as Error);
    }
  }

  private async requestHello(): Promise<Hello> {
    return this.rpc.request("hello", {
      client: "heliograph-web",
      codecs: await decodableCodecs(),
      session: this.origin?.session ?? this.address.session,
      instance: this.origin?.instance,
      name: participantName(),
    });
  }

  private onHelloError(error: Error): void {
    const code = error instanceof RpcError ? error.code : 0;
    const requested = this.origin?.session ?? this.address.session;
    if (code === ErrorCode.notFound && requested !== undefined) {
      this.origin = null;
      if (this.events.sessionMissing?.()) {
        this.reopen();
        return;
      }
      this.events.warning(`There is no session '${requested}'. This is the main session.`);
      this.address.session = undefined;
      void this.startSession(subprotocol);
      return;
    }
    if (code === ErrorCode.unauthenticated || code === ErrorCode.forbidden) {
      this.stop({ kind: "forbidden", detail: error.message });
      return;
    }
    this.post({ kind: "close" });
    this.rpc.close();
    if (code !== ErrorCode.full) this.events.warning(error.message);
    this.retryLater(code === ErrorCode.full ? "full" : "lost");
  }

  private async closed(code: number, reason: string, wasOpen: boolean): Promise<void> {
    clearTimeout(this.stableTimer);
    this.rpc.close();
    if (code === closeCode.version) {
      this.state.set({ kind: "wrong_version", detail: reason });
    } else if (code === closeCode.policy || code === closeCode.unauthorised) {
      this.state.set({ kind: "forbidden", detail: reason });
    } else if (code === closeCode.tryAgainLater) {
      this.retryLater("full");
    } else {
      // Browsers hide why an upgrade was rejected, plain HTTP does not: a server that answers there
      // with another protocol runs another version.
      const protocol = wasOpen ? null : ((await this.address.fetchHello())?.protocol ?? null);
      if (protocol && protocol !== subprotocol) {
        this.state.set({ kind: "wrong_version", detail: protocol });
      } else {
        this.rejectedUpgrades = protocol ? this.rejectedUpgrades + 1 : 0;
        this.retryLater(
          this.rejectedUpgrades >= rejectionsBeforeFallback ? "mjpeg_fallback" : "lost",
        );
      }
    }
  }

  private retryLater(kind: "lost" | "full" | "mjpeg_fallback"): void {
    const waitMs = this.backoff.next();
    this.state.set({ kind, retryAt: Date.now() + waitMs });
    clearTimeout(this.retryTimer);
    this.retryTimer = window.setTimeout(() => this.open(), waitMs);
  }

  private stop(state: ConnectionState): void {
    this.post({ kind: "close" });
    this.rpc.close();
    this.state.set(state);
  }

  /** A silently dropped connection looks open until a request times out. */
  private async checkAlive(): Promise<void> {
    const silent = performance.now() - this.lastMessageAt >= aliveCheckMs;
    if (this.state.value.kind !== "live" || !silent) return;
    try {
      await this.rpc.request("camera.get", {}, aliveTimeoutMs);
    } catch (error) {
      if (error instanceof RpcError && error.code !== 0) return;
      if (this.state.value.kind !== "live") return;
      this.post({ kind: "close" });
      this.rpc.close();
      this.retryLater("lost");
    }
  }
}
