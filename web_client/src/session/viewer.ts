// What this page knows about the session it watches, and what it can ask of it. No DOM here
// except the canvas that the pictures go to.

import {
  type AnimationState,
  type Camera,
  type Capture,
  type FrameStats,
  type Hello,
  type JsonObject,
  type Pick,
  type SceneInfo,
  type SceneList,
  type SceneProgress,
  type SessionInfo,
  ErrorCode,
} from "heliograph/messages.ts";
import { Codec } from "heliograph/frame_header.ts";
import { ChannelClosed, RpcError, type RpcPeer } from "heliograph/rpc.ts";
import { SessionRestore } from "./session_restore.ts";
import { ServerCapabilities } from "./server_capabilities.ts";
import { captureBlob, shrunk } from "../common/image_files.ts";
import { type RestoreHost, restore } from "./restore_view.ts";
import { SceneParts } from "./scene_parts.ts";
import { SettingsStore } from "./settings_store.ts";
import { Signal } from "../common/signal.ts";
import { type ControlState, explained, controlStateOf } from "./control_state.ts";
import { CanvasPainter } from "../stream/canvas_painter.ts";
import { Connection } from "../stream/connection.ts";
import { LatencyMeter } from "../stream/latency.ts";
import { RateMeter } from "../stream/rates.ts";
import { type DrawnFrame, clockMs } from "../stream/worker_messages.ts";
import { StreamRequests } from "./stream_requests.ts";
import { length, subtract } from "../common/vector.ts";
import { type ViewState, changesOf, clipState } from "./view_state.ts";

const statsIntervalMs = 250;
const progressSilenceMs = 20_000;

export const bufferSetting = "view.buffer";

export class Viewer {
  readonly connection: Connection;
  readonly rpc: RpcPeer;
  readonly settings: SettingsStore;
  readonly capabilities: ServerCapabilities;
  readonly parts: SceneParts;
  readonly stream: StreamRequests;
  readonly scenes = new Signal<SceneList>({ scenes: [], current: null });
  readonly scene = new Signal<SceneInfo | null>(null);
  readonly loading = new Signal<SceneProgress | null>(null);
  /** True while the session is being brought to a state that was asked for as a whole. */
  readonly restoring = new Signal(false);
  readonly camera = new Signal<Camera | null>(null);
  readonly animation = new Signal<AnimationState | null>(null);
  /** Who is here; null where the server does not tell. */
  readonly session = new Signal<SessionInfo | null>(null);
  /** Whether this page may change what is shown. */
  readonly controlState = new Signal<ControlState>({ kind: "may_change" });
  readonly stats = new Signal<FrameStats | null>(null);
  readonly frame = new Signal<DrawnFrame | null>(null);
  readonly latency = new LatencyMeter();
  readonly rates = new RateMeter();
  /** Says in one sentence what went wrong. */
  onError: (message: string) => void = () => {};
  /** Says in one sentence what is worth knowing. */
  onInfo: (message: string) => void = () => {};
  /** Goes to a pose, on a way that one can follow. */
  jumpTo: (camera: Camera) => void = (camera) => this.moveCamera(camera);
  /** Starts or stops the clip. */
  togglePlay: () => void = () => {};
  /** Keeps the view of now as a bookmark. */
  addBookmark: () => void = () => {};
  /** True while a hand is on the camera; poses from elsewhere then wait. */
  cameraBusy: () => boolean = () => false;
  private inputSeq = 0;
  private progressTimer = 0;
  private animationReadAt = 0;
  private animationRev = 0;
  /** The server's hello, from its arrival until the connection is gone. */
  private greeting: Hello | null = null;
  /** What the session still has to be brought to; a wish outlives lost connections. */
  private pendingViewState: ViewState | null = null;
  private readonly sessionRestore: SessionRestore;

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
      undecodable: (message, video) => {
        if (video) this.stream.videoBroke();
        else this.onError(`A picture could not be shown: ${message}`);
      },
    });
    this.rpc = this.connection.rpc;
    this.settings = new SettingsStore(this.rpc, (error) => this.report(error));
    this.capabilities = new ServerCapabilities(this.rpc);
    this.parts = new SceneParts({
      rpc: this.rpc,
      scene: this.scene,
      capabilities: this.capabilities,
      report: (error) => this.report(error),
    });
    this.sessionRestore = new SessionRestore({
      origin: () => this.connection.origin,
      mayChange: () => this.mayChange,
      viewState: () => (this.scene.value ? this.viewState() : null),
      clearScene: () => this.scene.set(null),
      arrivedAt: (origin, instanceChanged) => {
        this.connection.origin = origin;
        if (instanceChanged) void this.connection.persistRoute(origin);
      },
      inform: (sentence) => this.onInfo(sentence),
    });
    this.stream = new StreamRequests(this.rpc, {
      mayResize: () => this.mayChange,
      report: (error) => this.report(error),
      tell: (sentence) => this.onInfo(sentence),
    });
    this.connection.state.watch(({ kind }) => {
      if (kind === "live") return;
      this.greeting = null;
      this.stream.end();
      // What a server has at first, of another size or another view, would flash by.
      this.connection.hold();
    });
    this.animation.watch(() => (this.animationReadAt = Date.now()));
  }

  get hello(): Hello | null {
    const state = this.connection.state.value;
    return state.kind === "live" ? state.hello : null;
  }

  get mayChange(): boolean {
    return this.controlState.value.kind === "may_change";
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
      environment: this.parts.environment.value?.current,
      ...this.parts.edits(),
      settings: changesOf(this.settings.schema.value, this.settings.tree.value),
      clip: clipState(this.animation.value, this.animationReadAt),
      camera: this.camera.value ?? undefined,
    };
  }

  /** Brings the session to this state, now or when there is a connection. */
  show(state: ViewState): Promise<void> {
    this.pendingViewState = state;
    if (this.greeting) {
      this.dropForbiddenViewState();
      return this.restorePendingViewState();
    }
    this.connection.hold();
    return Promise.resolve();
  }

  /** Sends an absolute pose. Call at most once per animation frame. */
  moveCamera(camera: Camera): void {
    this.camera.set(camera);
    if (this.pendingViewState) this.pendingViewState.camera = camera;
    this.inputSeq += 1;
    this.latency.inputSent(this.inputSeq, clockMs());
    const { eye, target, up, vertical_fov } = camera;
    this.rpc.notify("camera.set", { eye, target, up, vertical_fov, seq: this.inputSeq });
  }

  /** Takes what the server tells of the clip, unless something newer came before. */
  onAnimationState(animation: AnimationState): void {
    if (animation.rev < this.animationRev) return;
    this.animationRev = animation.rev;
    this.animation.set(animation);
  }

  async selectCamera(name: string): Promise<void> {
    await this.attempt(async () => {
      this.inputSeq += 1;
      this.latency.inputSent(this.inputSeq, clockMs());
      this.camera.set(await this.rpc.request<Camera>("camera.set", { name, seq: this.inputSeq }));
    });
  }

  async fitCamera(): Promise<void> {
    if (this.pendingViewState || !this.mayChange) return;
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

  /** What lies under a point of the picture, in fractions of its width and height from the top left. */
  async pick(x: number, y: number): Promise<Pick | null> {
    if (!this.capabilities.has("scene.pick")) return null;
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
    const format = this.capabilities.captureFormats.value.has("jpeg") ? "jpeg" : "png";
    const capture = await this.capture(buffer, format);
    return shrunk(captureBlob(capture), width);
  }

  /** A buffer as a file; the one that is shown unless another is named. */
  async capture(name?: string, format = "png"): Promise<Capture> {
    const buffer = name ?? String(this.settings.value(bufferSetting) ?? "output");
    return this.rpc.request<Capture>("frame.capture", { buffer, format }, 120_000);
  }

  /** Says who may change things. */
  async control(wanted: object): Promise<void> {
    await this.attempt(async () => {
      this.setSession(await this.rpc.request<SessionInfo>("session.control", wanted));
    });
  }

  report(error: unknown): void {
    if (error instanceof ChannelClosed) return;
    const known = error instanceof RpcError ? error.sentence : (error as Error).message;
    this.onError(known);
  }

  private async becomeLive(hello: Hello): Promise<void> {
    this.greeting = hello;
    this.latency.reset();
    this.inputSeq = 0;
    this.animationRev = 0;
    await this.readSession();
    this.pendingViewState = this.sessionRestore.pendingStateFor(hello, this.pendingViewState);
    this.dropForbiddenViewState();
    await Promise.all([
      this.stream.begin(hello, this.pendingViewState !== null),
      this.settings.load(),
      this.refreshScenes(),
      this.attempt(() => this.capabilities.readBuffers()),
      this.attempt(() => this.capabilities.read()),
      this.attempt(() => this.rpc.request("stats.subscribe", { interval_ms: statsIntervalMs })),
    ]);
    if (this.pendingViewState) {
      void this.attempt(() => this.restorePendingViewState());
    } else {
      this.connection.release({ oldestRev: 0, size: this.stream.askedSize });
      await this.readScene();
      this.sessionRestore.arrived(hello);
    }
  }

  /** Who has no control gets to see what others chose, whatever a link says. */
  private dropForbiddenViewState(): void {
    if (!this.pendingViewState || this.mayChange) return;
    this.pendingViewState = null;
    this.onInfo(`The view of the link is not shown. ${explained(this.controlState.value)}`);
  }

  private async restorePendingViewState(): Promise<void> {
    const { greeting, pendingViewState: state } = this;
    if (!greeting || !state) return;
    const host: RestoreHost = {
      rpc: this.rpc,
      schema: () => this.settings.schema.value,
      capabilities: (method) => this.capabilities.has(method),
      wanted: () => this.greeting === greeting && this.pendingViewState === state,
      lost: (sentence) => this.onError(sentence),
      isOwn: () => this.sessionRestore.ownsSession(greeting),
    };
    this.restoring.set(true);
    if (this.connection.state.value.kind !== "live") this.frame.set(null);
    if (!(await restore(host, state))) return;
    this.pendingViewState = null;
    this.sessionRestore.arrived(greeting);
    try {
      await Promise.all([this.settings.load(), this.refreshScenes(), this.readScene()]);
      this.connection.release({ oldestRev: this.camera.value?.rev ?? 0 });
      await this.stream.show();
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
      this.onAnimationState(await this.rpc.request<AnimationState>("animation.list"));
    } catch (error) {
      const waiting =
        error instanceof RpcError &&
        (error.code === ErrorCode.notReady || error.code === ErrorCode.notFound);
      if (!waiting) throw error;
    }
  }

  /** Nothing, where the server has no sessions to tell of. */
  private async readSession(): Promise<void> {
    try {
      this.setSession(await this.rpc.request<SessionInfo>("session.info"));
    } catch (error) {
      if (error instanceof ChannelClosed) throw error;
    }
  }

  /** The list is the same for all who get it; which entry is ours the greeting told. */
  private setSession(session: SessionInfo): void {
    const own = this.greeting?.viewer;
    const viewers = session.viewers.map((one) => ({ ...one, you: one.viewer === own }));
    this.session.set({ ...session, viewers });
    this.controlState.set(controlStateOf(this.session.value, this.greeting?.role));
    this.stream.sizeTold(session);
    this.stream.updateSize();
  }

  private async sceneChanged(info: SceneInfo): Promise<void> {
    // While a wish is carried out this may be a scene on the way: what is wished for stays.
    if (this.pendingViewState) return;
    this.showProgress(null);
    this.scene.set(info);
    this.scenes.set({ ...this.scenes.value, current: info.name });
    await this.attempt(() => this.readScene());
    await this.attempt(() => this.capabilities.readBuffers());
  }

  private frameDrawn(frame: DrawnFrame): void {
    this.rates.add(frame.drawnAt, frame.bytes);
    this.latency.frameDrawn(frame.inputSeqEcho, frame.drawnAt);
    if (frame.codec === Codec.h264) this.stream.videoWorked();
    this.frame.set(frame);
  }

  private notified(method: string, params: unknown): void {
    switch (method) {
      case "settings.changed":
        this.settings.receive((params as { patch: JsonObject }).patch);
        break;
      case "camera.changed":
        if (this.pendingViewState || this.cameraBusy()) break;
        this.camera.set((params as { camera: Camera }).camera);
        break;
      case "animation.changed":
        if (this.pendingViewState) break;
        this.onAnimationState((params as { animation: AnimationState }).animation);
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
