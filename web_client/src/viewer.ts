// What this page knows about the session it watches, and what it can ask of it. No DOM here
// except the canvas that the pictures go to.

import {
  type AnimationState,
  type BufferInfo,
  type Camera,
  type Capture,
  type FrameStats,
  type Hello,
  type JsonObject,
  type Pick,
  type PresetInfo,
  type SceneInfo,
  type SceneList,
  type SceneProgress,
  type SessionInfo,
  type StreamSettings,
  ErrorCode,
} from "heliograph/messages.ts";
import { type OpenRpc, choicesOf } from "heliograph/openrpc.ts";
import { ChannelClosed, RpcError, type RpcPeer } from "heliograph/rpc.ts";
import { captureBlob, shrunk } from "./pictures.ts";
import { preferences } from "./preferences.ts";
import { type RestoreHost, restore } from "./restore.ts";
import { SceneParts } from "./scene_parts.ts";
import { SettingsStore } from "./settings_store.ts";
import { Signal } from "./signal.ts";
import { CanvasPainter } from "./stream/canvas_painter.ts";
import { Connection } from "./stream/connection.ts";
import { LatencyMeter } from "./stream/latency.ts";
import { RateMeter } from "./stream/rates.ts";
import { type DrawnFrame, clockMs } from "./stream/worker_messages.ts";
import { length, subtract } from "./view/vector.ts";
import type { PictureSize } from "./view/viewport.ts";
import { type ViewState, changesOf, clipState } from "./view_state.ts";

const statsIntervalMs = 250;
const progressSilenceMs = 20_000;

export const bufferSetting = "view.buffer";

export class Viewer {
  readonly connection: Connection;
  readonly rpc: RpcPeer;
  readonly settings: SettingsStore;
  readonly parts: SceneParts;
  readonly scenes = new Signal<SceneList>({ scenes: [], current: null });
  readonly scene = new Signal<SceneInfo | null>(null);
  readonly loading = new Signal<SceneProgress | null>(null);
  /** True while the session is being brought to a state that was asked for as a whole. */
  readonly restoring = new Signal(false);
  readonly camera = new Signal<Camera | null>(null);
  readonly animation = new Signal<AnimationState | null>(null);
  /** Who is here; null where the server does not tell. */
  readonly session = new Signal<SessionInfo | null>(null);
  readonly buffers = new Signal<BufferInfo[]>([]);
  /** File formats of `capture`. */
  readonly captureFormats = new Signal<ReadonlySet<string>>(new Set(["png"]));
  readonly presets = new Signal<PresetInfo[]>([]);
  /** Names of the methods that this server has; what it lacks is not offered. */
  readonly methods = new Signal<ReadonlySet<string>>(new Set());
  readonly stats = new Signal<FrameStats | null>(null);
  readonly frame = new Signal<DrawnFrame | null>(null);
  readonly stream = new Signal<StreamSettings | null>(null);
  readonly latency = new LatencyMeter();
  readonly rates = new RateMeter();
  /** Says in one sentence what went wrong. */
  onError: (message: string) => void = () => {};
  /** Goes to a pose, on a way that one can follow. */
  jumpTo: (camera: Camera) => void = (camera) => this.moveCamera(camera);
  /** Starts or stops the clip. */
  togglePlay: () => void = () => {};
  /** Keeps the view of now as a bookmark. */
  keepView: () => void = () => {};
  /** True while a hand is on the camera; poses from elsewhere then wait. */
  cameraBusy: () => boolean = () => false;
  /** The size of picture that suits the view and this server. */
  chooseSize: (hello: Hello) => PictureSize = () => ({ width: 640, height: 360 });
  private inputSeq = 0;
  private askedSize: PictureSize | null = null;
  private wantedStream: Partial<StreamSettings> = {};
  private progressTimer = 0;
  private animationReadAt = 0;
  /** The server's hello, from its arrival until the connection is gone. */
  private greeting: Hello | null = null;
  /** The run of the server that this page was last in step with. */
  private instance: string | null = null;
  /** What the session still has to be brought to; a wish outlives lost connections. */
  private wish: ViewState | null = null;

  constructor(base: string, canvas: HTMLCanvasElement) {
    const offscreen =
      typeof canvas.transferControlToOffscreen === "function"
        ? canvas.transferControlToOffscreen()
        : null;
    const painter = offscreen ? null : new CanvasPainter(canvas);
    this.connection = new Connection(base, offscreen, {
      live: (hello) => this.becomeLive(hello),
      notification: (method, params) => this.notified(method, params),
      drawn: (frame) => this.frameDrawn(frame),
      draw: (picture, frame) => painter?.draw(picture, frame.width, frame.height),
      warning: (message) => this.onError(message),
    }, new URL(base).searchParams.get("session") ?? undefined);
    this.rpc = this.connection.rpc;
    this.settings = new SettingsStore(this.rpc, (error) => this.report(error));
    this.parts = new SceneParts(this);
    this.connection.state.watch(({ kind }) => {
      if (kind === "live") return;
      this.greeting = null;
      // The view that a new server starts with would flash by before the wish is carried out.
      if (this.scene.value || this.wish) this.connection.hold();
    });
    this.animation.watch(() => (this.animationReadAt = Date.now()));
  }

  get hello(): Hello | null {
    const state = this.connection.state.value;
    return state.kind === "live" ? state.hello : null;
  }

  /** Whether this page may change what is shown; false while another viewer has control. */
  get inControl(): boolean {
    const me = this.session.value?.viewers.find(({ you }) => you);
    return me?.control ?? true;
  }

  /** Largest extent of the scene in metres; 1 while none is known. */
  sceneSize(): number {
    const bounds = this.scene.value?.bounds;
    const size = bounds ? length(subtract(bounds.max, bounds.min)) : 0;
    return size > 0 && Number.isFinite(size) ? size : 1;
  }

  /** What the page shows, complete enough to be shown again elsewhere. */
  viewState(): ViewState {
    const scene = this.scene.value;
    return {
      scene: scene?.name,
      part: scene?.scene || undefined,
      variant: scene?.variant ?? undefined,
      environment: this.parts.environment.value?.current ?? undefined,
      settings: changesOf(this.settings.schema.value, this.settings.tree.value),
      clip: clipState(this.animation.value, this.animationReadAt),
      camera: this.camera.value ?? undefined,
    };
  }

  /** Brings the session to this state, now or when there is a connection. */
  show(state: ViewState): Promise<void> {
    this.wish = state;
    if (this.greeting) return this.carryOutWish();
    this.connection.hold();
    return Promise.resolve();
  }

  /** Sends an absolute pose. Call at most once per animation frame. */
  moveCamera(camera: Camera): void {
    this.camera.set(camera);
    if (this.wish) this.wish.camera = camera;
    this.inputSeq += 1;
    this.latency.inputSent(this.inputSeq, clockMs());
    const { eye, target, up, vertical_fov } = camera;
    this.rpc.notify("camera.set", { eye, target, up, vertical_fov, seq: this.inputSeq });
  }

  async selectCamera(name: string): Promise<void> {
    await this.attempt(async () => {
      this.inputSeq += 1;
      this.latency.inputSent(this.inputSeq, clockMs());
      this.camera.set(await this.rpc.request<Camera>("camera.set", { name, seq: this.inputSeq }));
    });
  }

  async fitCamera(): Promise<void> {
    if (this.wish) return;
    await this.attempt(async () => this.camera.set(await this.rpc.request<Camera>("camera.fit")));
  }

  async loadScene(name: string, part: { scene?: string; variant?: string } = {}): Promise<void> {
    this.showProgress({ name, stage: "starting", fraction: 0 });
    try {
      const tenMinutes = 600_000;
      const info = await this.rpc.request<SceneInfo>("scene.load", { name, ...part }, tenMinutes);
      await this.sceneChanged(info);
    } catch (error) {
      this.showProgress(null);
      this.report(error);
    }
  }

  /** Ends the load that is under way. */
  async cancelLoad(): Promise<void> {
    await this.attempt(() => this.rpc.request("scene.cancel"));
  }

  async refreshScenes(): Promise<void> {
    await this.attempt(async () => {
      this.scenes.set(await this.rpc.request<SceneList>("scene.list"));
    });
  }

  /** Asks for pictures of another size if the view, the screen or the choice has changed. */
  updateSize(): void {
    if (!this.greeting) return;
    const size = this.chooseSize(this.greeting);
    const before = this.askedSize;
    if (before && before.width === size.width && before.height === size.height) return;
    this.askedSize = size;
    void this.configureStream(size);
  }

  /** What lies under a point of the picture, in fractions of its width and height from the top left. */
  async pick(x: number, y: number): Promise<Pick | null> {
    if (!this.methods.value.has("scene.pick")) return null;
    try {
      const pick = await this.rpc.request<Pick>("scene.pick", { x, y });
      return pick.hit ? pick : null;
    } catch (error) {
      this.report(error);
      return null;
    }
  }

  /** A buffer of the frame as a small picture, a data address. */
  async smallPicture(buffer: string, width: number): Promise<string> {
    const format = this.captureFormats.value.has("jpeg") ? "jpeg" : "png";
    const capture = await this.capture(buffer, format);
    return shrunk(captureBlob(capture), width);
  }

  /** Changes the stream; remembered for the next connection. */
  requestStream(change: Partial<StreamSettings>): void {
    this.wantedStream = { ...this.wantedStream, ...change };
    void this.configureStream(change);
  }

  /** A buffer as a file; the one that is shown unless another is named. */
  async capture(name?: string, format = "png"): Promise<Capture> {
    const buffer = name ?? String(this.settings.value(bufferSetting) ?? "output");
    return this.rpc.request<Capture>("frame.capture", { buffer, format }, 120_000);
  }

  report(error: unknown): void {
    if (error instanceof ChannelClosed) return;
    const known = error instanceof RpcError ? error.sentence : (error as Error).message;
    this.onError(known);
  }

  private async becomeLive(hello: Hello): Promise<void> {
    const goesOn = hello.instance === this.instance;
    if (this.instance && !goesOn && !this.wish && this.scene.value) this.wish = this.viewState();
    this.greeting = hello;
    this.latency.reset();
    this.inputSeq = 0;
    this.askedSize = this.chooseSize(hello);
    const unseen = this.wish ? { paused: true } : {};
    const codec = preferences.text("codec", isLocal() ? "jpeg" : "h264");
    const coded = hello.codecs.length > 1 && hello.codecs.includes(codec) ? { codec } : {};
    await Promise.all([
      this.configureStream({ ...this.wantedStream, ...this.askedSize, ...coded, ...unseen }),
      this.settings.load(),
      this.refreshScenes(),
      this.attempt(() => this.readBuffers()),
      this.attempt(() => this.readOffers()),
      this.attempt(() => this.rpc.request("stats.subscribe", { interval_ms: statsIntervalMs })),
    ]);
    if (this.wish) {
      void this.attempt(() => this.carryOutWish());
    } else {
      this.connection.release(0);
      await this.readScene();
      this.instance = hello.instance;
    }
  }

  private async carryOutWish(): Promise<void> {
    const { greeting, wish } = this;
    if (!greeting || !wish) return;
    const host: RestoreHost = {
      rpc: this.rpc,
      schema: () => this.settings.schema.value,
      wanted: () => this.greeting === greeting && this.wish === wish,
      lost: (sentence) => this.onError(sentence),
    };
    this.restoring.set(true);
    if (this.connection.state.value.kind !== "live") this.frame.set(null);
    if (!(await restore(host, wish))) return;
    this.wish = null;
    this.instance = greeting.instance;
    try {
      await Promise.all([this.settings.load(), this.refreshScenes(), this.readScene()]);
      this.connection.release(this.camera.value?.rev ?? 0);
      await this.configureStream({ paused: this.wantedStream.paused ?? false });
    } finally {
      this.restoring.set(false);
    }
  }

  /** Reads what is shown; there may be nothing yet. */
  private async readScene(): Promise<void> {
    try {
      const info = await this.rpc.request<SceneInfo>("scene.info");
      const camera = await this.rpc.request<Camera>("camera.get");
      this.scene.set(info);
      this.showProgress(null);
      this.camera.set(camera);
      this.animation.set(await this.rpc.request<AnimationState>("animation.list"));
    } catch (error) {
      const waiting =
        error instanceof RpcError &&
        (error.code === ErrorCode.notReady || error.code === ErrorCode.notFound);
      if (!waiting) throw error;
    }
  }

  private async readBuffers(): Promise<void> {
    const answer = await this.rpc.request<{ buffers: BufferInfo[] }>("frame.buffers");
    this.buffers.set(answer.buffers);
  }

  private async readOffers(): Promise<void> {
    const [openrpc, answer] = await Promise.all([
      this.rpc.request<OpenRpc>("rpc.discover"),
      this.rpc.request<{ presets: PresetInfo[] }>("settings.presets"),
    ]);
    this.methods.set(new Set(openrpc.methods.map(({ name }) => name)));
    this.captureFormats.set(new Set(choicesOf(openrpc, "frame.capture", "format")));
    this.presets.set(answer.presets);
    if (this.methods.value.has("session.info")) {
      this.setSession(await this.rpc.request<SessionInfo>("session.info"));
    }
  }

  /** The list is the same for all who get it; which entry is ours the greeting told. */
  private setSession(session: SessionInfo): void {
    const own = this.greeting?.viewer;
    const viewers = session.viewers.map((one) => ({ ...one, you: one.viewer === own }));
    this.session.set({ ...session, viewers });
  }

  private async sceneChanged(info: SceneInfo): Promise<void> {
    // While a wish is carried out this may be a scene on the way: what is wished for stays.
    if (this.wish) return;
    this.showProgress(null);
    this.scene.set(info);
    this.scenes.set({ ...this.scenes.value, current: info.name });
    await this.attempt(() => this.readScene());
    await this.attempt(() => this.readBuffers());
  }

  private async configureStream(change: Partial<StreamSettings>): Promise<void> {
    if (Object.keys(change).length === 0 || !this.greeting) return;
    await this.attempt(async () => {
      this.stream.set(await this.rpc.request<StreamSettings>("stream.configure", change));
    });
  }

  private frameDrawn(frame: DrawnFrame): void {
    this.rates.add(frame.drawnAt, frame.bytes);
    this.latency.frameDrawn(frame.inputSeqEcho, frame.drawnAt);
    this.frame.set(frame);
  }

  private notified(method: string, params: unknown): void {
    switch (method) {
      case "settings.changed":
        this.settings.receive((params as { patch: JsonObject }).patch);
        break;
      case "camera.changed":
        if (this.wish || this.cameraBusy()) break;
        this.camera.set((params as { camera: Camera }).camera);
        break;
      case "scene.changed":
        void this.sceneChanged((params as { scene: SceneInfo }).scene);
        break;
      case "session.changed":
        this.setSession(params as SessionInfo);
        break;
      case "lights.changed":
      case "materials.changed":
      case "environment.changed":
        this.parts.notified(method, params);
        break;
      case "scene.progress":
        this.showProgress(params as SceneProgress);
        break;
      case "stats.frame":
        this.stats.set(params as FrameStats);
        break;
    }
  }

  /** A load that another viewer started may fail without word; its bar must not stay for ever. */
  private showProgress(progress: SceneProgress | null): void {
    clearTimeout(this.progressTimer);
    this.loading.set(progress);
    if (progress) {
      this.progressTimer = window.setTimeout(() => this.loading.set(null), progressSilenceMs);
    }
  }

  private async attempt(action: () => Promise<unknown>): Promise<void> {
    try {
      await action();
    } catch (error) {
      this.report(error);
    }
  }
}

/** JPEG is the sharper picture in motion; away from this machine bandwidth counts for more. */
function isLocal(): boolean {
  return ["localhost", "127.0.0.1", "[::1]"].includes(location.hostname);
}
