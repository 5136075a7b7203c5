// The connection to the server: opens it, says hello, notices loss, comes back.

import { type Hello, ErrorCode, subprotocol } from "heliograph/messages.ts";
import { ChannelClosed, RpcError, RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import { participantName } from "../common/preferences.ts";
import { Backoff } from "./backoff.ts";
import { decodableCodecs } from "./codecs.ts";
import { type SessionOrigin, SessionAddress, mainSession, rendezvousRoute } from "./session_address.ts";
import type { DrawnFrame, Freshness, FromWorker, ToWorker } from "./worker_messages.ts";

export type ConnectionState =
  | { kind: "connecting" }
  | { kind: "live"; hello: Hello }
  | { kind: "lost"; retryAt: number }
  /** The server answers, but nothing between us lets a WebSocket through. */
  | { kind: "mjpeg_fallback"; retryAt: number }
  | { kind: "wrong_version"; detail: string }
  | { kind: "full"; retryAt: number }
  | { kind: "forbidden"; detail: string };

export interface ConnectionEvents {
  live(hello: Hello): Promise<void>;
  notification(method: string, params: unknown): void;
  drawn(frame: DrawnFrame): void;
  /** Only where the worker cannot draw: shows the picture and takes ownership of it. */
  draw(picture: ImageBitmap | VideoFrame, frame: DrawnFrame): void;
  warning(message: string): void;
  /** A picture was lost; of a video also those that would have built on it. */
  undecodable(message: string, video: boolean): void;
}

const closeCode = { policy: 1008, tryAgainLater: 1013, unauthorised: 4001, version: 4005 };
const stableAfterMs = 5000;
const refusalsBeforeFallback = 2;
const aliveCheckMs = 15_000;
const aliveTimeoutMs = 10_000;
/** Who may only watch finds the others on another server once they have found their place. */
const watchersComeAfterMs = 2000;

export class Connection {
  readonly state = new Signal<ConnectionState>({ kind: "connecting" });
  readonly rpc: RpcPeer;
  readonly place: SessionAddress;
  /** The session to come back to. On another server whose place is taken, it finds a new one. */
  origin: SessionOrigin | null = null;
  private readonly worker: Worker;
  private readonly events: ConnectionEvents;
  private readonly backoff = new Backoff();
  private retryTimer = 0;
  private stableTimer = 0;
  private heardAt = 0;
  private refusals = 0;
  private watches = false;
  private readonly disposal = new AbortController();
  private readonly aliveTimer: number;
  private lastCopy = 0;
  private readonly copies = new Map<number, (picture: ImageBitmap | null) => void>();
  private takeCopy: ((picture: ImageBitmap) => void) | null = null;

  constructor(
    base: string,
    canvas: OffscreenCanvas | null,
    events: ConnectionEvents,
    place = SessionAddress.ofPage(base),
  ) {
    this.place = place;
    this.events = events;
    this.worker = new Worker(new URL("worker.js", base), { name: "stream" });
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.receive(data);
    this.worker.onerror = () => this.events.warning("The stream worker could not be started");
    this.rpc = new RpcPeer(
      (text) => this.post({ kind: "send", text }),
      (method, params) => this.events.notification(method, params),
    );
    if (canvas) this.post({ kind: "canvas", canvas }, [canvas]);
    const { signal } = this.disposal;
    addEventListener("online", () => this.retryNow(), { signal });
    const seen = (): void => {
      if (!document.hidden) this.retryNow();
    };
    document.addEventListener("visibilitychange", seen, { signal });
    this.aliveTimer = window.setInterval(() => void this.checkAlive(), aliveCheckMs);
  }

  /** Closes for good. */
  dispose(): void {
    this.disposal.abort();
    clearInterval(this.aliveTimer);
    clearTimeout(this.retryTimer);
    clearTimeout(this.stableTimer);
    this.rpc.close();
    this.worker.terminate();
  }

  /** Tells the server anew what this person is called. */
  reintroduce(): void {
    if (this.state.value.kind === "live") void this.greet().catch(() => {});
  }

  open(): void {
    clearTimeout(this.retryTimer);
    this.retryTimer = 0;
    void this.findWay().then(() => {
      const url = this.place.address("ws");
      url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
      this.post({ kind: "open", url: url.href, subprotocol });
    });
  }

  /** Another server than before: there we go where the others from that session go too. */
  private async findWay(): Promise<void> {
    const { origin, place } = this;
    if (!origin) return;
    const there = await place.fetchHello();
    if (!there || there.instance === origin.instance) return;
    place.route = rendezvousRoute(origin);
    if (this.watches) await new Promise((resolve) => setTimeout(resolve, watchersComeAfterMs));
  }

  /** Has the page's address lead to the session that was found, after a reload too. */
  async persistRoute({ instance, session }: SessionOrigin): Promise<void> {
    const { place } = this;
    place.session = session;
    if (session === mainSession && (await place.fetchHello(null))?.instance === instance) {
      place.route = null; // the page's bare address leads here
    }
    history.replaceState(null, "", place.pageUrl(location.href));
  }

  /** A copy of the picture that is shown; null while there is none. */
  copyFrame(): Promise<ImageBitmap | null> {
    const id = ++this.lastCopy;
    return new Promise((resolve) => {
      this.copies.set(id, resolve);
      this.post({ kind: "copy", id });
    });
  }

  /** Takes a copy of every picture drawn from now on, and with it the duty to close it. */
  set pictureCopies(take: ((picture: ImageBitmap) => void) | null) {
    this.takeCopy = take;
    this.post({ kind: "copies", wanted: take !== null });
  }

  /** Pictures that arrive wait for `release`, which shows those that are new enough. */
  hold(): void {
    this.post({ kind: "hold" });
  }

  release(from: Freshness): void {
    this.post({ kind: "release", from });
  }

  /** Cuts a waiting time short, after a click or when the network is back. */
  retryNow(): void {
    if (this.retryTimer) this.open();
  }

  private post(message: ToWorker, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }

  private receive(message: FromWorker): void {
    this.heardAt = performance.now();
    switch (message.kind) {
      case "opened":
        this.refusals = 0;
        this.rpc.open();
        void this.sayHello(message.subprotocol);
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
      case "picture":
        this.events.draw(message.picture, message.frame);
        this.events.drawn(message.frame);
        break;
      case "copied":
        this.copied(message.id, message.picture);
        break;
      case "undecodable":
        this.events.undecodable(message.message, message.video);
        break;
    }
  }

  private copied(id: number, picture: ImageBitmap | null): void {
    const asked = this.copies.get(id);
    this.copies.delete(id);
    if (asked) asked(picture);
    else if (picture && this.takeCopy) this.takeCopy(picture);
    else picture?.close();
  }

  private async sayHello(spoken: string): Promise<void> {
    if (spoken !== subprotocol) {
      this.stop({ kind: "wrong_version", detail: spoken || "no known version" });
      return;
    }
    try {
      const hello = await this.greet();
      if (hello.protocol !== subprotocol) {
        this.stop({ kind: "wrong_version", detail: hello.protocol });
        return;
      }
      this.watches = hello.role === "view";
      await this.events.live(hello);
      this.state.set({ kind: "live", hello });
      clearTimeout(this.stableTimer);
      this.stableTimer = window.setTimeout(() => this.backoff.reset(), stableAfterMs);
    } catch (error) {
      if (error instanceof ChannelClosed) return;
      this.helloRefused(error as Error);
    }
  }

  private async greet(): Promise<Hello> {
    return this.rpc.request<Hello>("hello", {
      client: "heliograph-web",
      codecs: await decodableCodecs(),
      session: this.origin?.session ?? this.place.session,
      instance: this.origin?.instance,
      name: participantName(),
    });
  }

  private helloRefused(error: Error): void {
    const code = error instanceof RpcError ? error.code : 0;
    const wanted = this.origin?.session ?? this.place.session;
    if (code === ErrorCode.notFound && wanted !== undefined) {
      this.events.warning(`There is no session ${wanted} here; this is the main one`);
      this.place.session = undefined;
      this.origin = null;
      void this.sayHello(subprotocol);
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
      // A browser does not tell why an upgrade was refused. Plain HTTP does: a server that answers
      // there but names another protocol is alive and merely of another version.
      const spoken = wasOpen ? null : ((await this.place.fetchHello())?.protocol ?? null);
      if (spoken && spoken !== subprotocol) {
        this.state.set({ kind: "wrong_version", detail: spoken });
      } else {
        this.refusals = spoken ? this.refusals + 1 : 0;
        this.retryLater(this.refusals >= refusalsBeforeFallback ? "mjpeg_fallback" : "lost");
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

  /** A silently dropped network path looks open for ever unless something asks now and then. */
  private async checkAlive(): Promise<void> {
    const quiet = performance.now() - this.heardAt >= aliveCheckMs;
    if (this.state.value.kind !== "live" || !quiet) return;
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
