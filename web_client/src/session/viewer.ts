// The session that this page shows, and the calls that change it. No DOM here except the canvas
// that the frames are drawn to.

import { Codec } from "heliograph/frame_header.ts";
import type { Vector3 } from "heliograph/json.ts";
import {
  type AnimationState,
  type Capture,
  type FrameCaptureParams,
  type FrameStats,
  type Hello,
  type Notifications,
  type Pick,
  type SceneInfo,
  type SceneList,
  type SceneProgress,
  type SessionControlParams,
  type SessionInfo,
  ErrorCode,
} from "heliograph/messages.ts";
import { ChannelClosed, RpcError, type RpcPeer } from "heliograph/rpc.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import { captureBlob, thumbnailUrl } from "../common/image_files.ts";
import { Signal } from "../common/signal.ts";
import { length, subtract } from "../common/vector.ts";
import { CanvasPainter } from "../stream/canvas_painter.ts";
import { Connection } from "../stream/connection.ts";
import { LatencyMeter } from "../stream/latency.ts";
import { RateMeter } from "../stream/rates.ts";
import { type DrawnFrame, clockMs } from "../stream/worker_messages.ts";
import { type ControlState, controlStateOf, describeControl } from "./control_state.ts";
import { type RestoreHost, restoreView } from "./restore_view.ts";
import { SceneParts } from "./scene_parts.ts";
import { ServerCapabilities } from "./server_capabilities.ts";
import { SessionRestore } from "./session_restore.ts";
import { SettingsStore } from "./settings_store.ts";
import { StreamRequests } from "./stream_requests.ts";
import { type ViewState, changesOf, clipState } from "./view_state.ts";

const statsIntervalMs = 250;
const progressTimeoutMs = 20_000;
const loadTimeoutMs = 600_000;
const captureTimeoutMs = 120_000;

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
  /** True while a whole view state is being restored. */
  readonly restoring = new Signal(false);
  readonly camera = new Signal<CameraPose | null>(null);
  readonly animation = new Signal<AnimationState | null>(null);
  /** The session and its viewers; null where the server does not tell. */
  readonly session = new Signal<SessionInfo | null>(null);
  /** Whether this page may change the session. */
  readonly controlState = new Signal<ControlState>({ kind: "may_change" });
  readonly stats = new Signal<FrameStats | null>(null);
  readonly frame = new Signal<DrawnFrame | null>(null);
  readonly latency = new LatencyMeter();
  readonly rates = new RateMeter();
  /** Shows an error as one sentence. */
  onError: (message: string) => void = () => {};
  /** Shows other news as one sentence. */
  onInfo: (message: string) => void = () => {};
  /** Moves to a pose in a visible transition. */
  animateCameraTo: (camera: CameraPose) => void = (camera) => this.moveCamera(camera);
  /** Starts or stops the clip. */
  togglePlay: () => void = () => {};
  /** Stores the current view as a bookmark. */
  addBookmark: () => void = () => {};
  /** True while the user moves the camera; poses of other viewers are then ignored. */
  cameraBusy: () => boolean = () => false;
  private inputSeq = 0;
  private progressTimer = 0;
  private animationReadAt = 0;
  private animationRev = 0;
  /** From the arrival of the server's hello until the connection is lost. */
  private receivedHello: Hello | null = null;
  /** The state that is still to be restored; it survives lost connections. */
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
      draw: (image, frame) => painter?.draw(image, frame.width, frame.height),
      warning: (message) => this.onError(message),
      decodeFailed: (message, video) => {
        if (video) this.stream.onVideoError();
        else this.onError(`A frame could not be shown: ${message}`);
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
      inform: (sentence) => this.onInfo(sentence),
    });
    this.connection.state.watch(({ kind }) => {
      if (kind === "live") return;
      this.receivedHello = null;
      this.stream.end();
      // The first frames of a new connection may have another size or view.
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

  /** Largest extent of the scene in metres; 1 while it is unknown. */
  sceneSize(): number {
    const bounds = this.scene.value?.bounds;
    const size = bounds ? length(subtract(bounds.max, bounds.min)) : 0;
    return size > 0 && Number.isFinite(size) ? size : 1;
  }

  /** What the page shows, complete enough to restore it in another session. */
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

  /** Restores this state, now or as soon as there is a connection. */
  show(state: ViewState): Promise<void> {
    this.pendingViewState = state;
    if (this.receivedHello) {
      this.dropViewStateWithoutControl();
      return this.restorePendingViewState();
    }
    this.connection.hold();
    return Promise.resolve();
  }

  /** Sends an absolute pose. Call at most once per animation frame. */
  moveCamera(camera: CameraPose): void {
    this.camera.set(camera);
    if (this.pendingViewState) this.pendingViewState.camera = camera;
    this.inputSeq += 1;
    this.latency.inputSent(this.inputSeq, clockMs());
    const { eye, target, up, vertical_fov } = camera;
    this.rpc.notify("camera.set", { eye, target, up, vertical_fov, seq: this.inputSeq });
  }

  /** Takes the state of the animation, unless a newer one came before. */
  onAnimationState(animation: AnimationState): void {
    if (animation.rev < this.animationRev) return;
    this.animationRev = animation.rev;
    this.animation.set(animation);
  }

  async selectCamera(name: string): Promise<void> {
    await this.attempt(async () => {
      this.inputSeq += 1;
      this.latency.inputSent(this.inputSeq, clockMs());
      this.camera.set(await this.rpc.request("camera.set", { name, seq: this.inputSeq }));
    });
  }

  async fitCamera(): Promise<void> {
    if (this.pendingViewState || !this.mayChange) return;
    await this.attempt(async () => this.camera.set(await this.rpc.request("camera.fit")));
  }

  async loadScene(name: string, part: { scene?: string; variant?: string } = {}): Promise<void> {
    this.showProgress({ name, stage: "starting", fraction: 0 });
    try {
      const info = await this.rpc.request("scene.load", { name, ...part }, loadTimeoutMs);
      await this.sceneChanged(info);
    } catch (error) {
      this.showProgress(null);
      this.report(error);
    }
  }

  /** Cancels the running load. */
  async cancelLoad(): Promise<void> {
    await this.attempt(() => this.rpc.request("scene.cancel"));
  }

  async refreshScenes(): Promise<void> {
    await this.attempt(async () => {
      this.scenes.set(await this.rpc.request("scene.list"));
    });
  }

  /** The surface at a point, given in fractions of the image size from the top left. */
  async pick(x: number, y: number): Promise<Pick | null> {
    if (!this.capabilities.has("scene.pick")) return null;
    try {
      const pick = await this.rpc.request("scene.pick", { x, y });
      return pick.hit ? pick : null;
    } catch (error) {
      this.report(error);
      return null;
    }
  }

  /** The surface at a point of the view, world space; null where none is known. Reports no errors. */
  async surfaceAt(x: number, y: number): Promise<Vector3 | null> {
    if (!this.mayChange || !this.capabilities.has("scene.pick")) return null;
    try {
      return (await this.rpc.request("scene.pick", { x, y })).position;
    } catch {
      return null;
    }
  }

  /** A buffer of the frame as a small image, in a data URL. */
  async captureThumbnail(buffer: string, width: number): Promise<string> {
    const format = this.capabilities.captureFormats.value.has("jpeg") ? "jpeg" : "png";
    const capture = await this.capture(buffer, format);
    return thumbnailUrl(captureBlob(capture), width);
  }

  /** A buffer as a file; by default the one that is shown, converged. */
  async capture(
    name?: string,
    format: FrameCaptureParams["format"] = "png",
    samples?: number,
  ): Promise<Capture> {
    const buffer = name ?? String(this.settings.value(bufferSetting) ?? "output");
    const params = samples === undefined ? { buffer, format } : { buffer, format, samples };
    return this.rpc.request("frame.capture", params, captureTimeoutMs);
  }

  /** Takes or passes on control of the session, or changes its mode. */
  async setControl(params: SessionControlParams): Promise<void> {
    await this.attempt(async () => {
      this.setSession(await this.rpc.request("session.control", params));
    });
  }

  report(error: unknown): void {
    if (error instanceof ChannelClosed) return;
    this.onError(error instanceof RpcError ? error.sentence : (error as Error).message);
  }

  private async becomeLive(hello: Hello): Promise<void> {
    this.receivedHello = hello;
    this.latency.reset();
    this.inputSeq = 0;
    this.animationRev = 0;
    await this.readSession();
    this.pendingViewState = this.sessionRestore.pendingStateFor(hello, this.pendingViewState);
    this.dropViewStateWithoutControl();
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
      this.connection.release({ oldestRev: 0, size: this.stream.requestedSize });
      await this.readScene();
      this.sessionRestore.arrived(hello);
    }
  }

  /** Without control, the page shows what other viewers chose, not what its link says. */
  private dropViewStateWithoutControl(): void {
    if (!this.pendingViewState || this.mayChange) return;
    this.pendingViewState = null;
    this.onInfo(
      `The view in the link was not applied. ${describeControl(this.controlState.value)}`,
    );
  }

  private async restorePendingViewState(): Promise<void> {
    const { receivedHello: hello, pendingViewState: state } = this;
    if (!hello || !state) return;
    const host: RestoreHost = {
      rpc: this.rpc,
      schema: () => this.settings.schema.value,
      supports: (method) => this.capabilities.has(method),
      isCurrent: () => this.receivedHello === hello && this.pendingViewState === state,
      reportSkipped: (sentence) => this.onError(sentence),
      ownsSession: () => this.sessionRestore.ownsSession(hello),
    };
    this.restoring.set(true);
    if (this.connection.state.value.kind !== "live") this.frame.set(null);
    if (!(await restoreView(host, state))) return;
    this.pendingViewState = null;
    this.sessionRestore.arrived(hello);
    try {
      await Promise.all([this.settings.load(), this.refreshScenes(), this.readScene()]);
      this.connection.release({ oldestRev: this.camera.value?.rev ?? 0 });
      await this.stream.resume();
    } finally {
      this.restoring.set(false);
    }
  }

  /** Reads scene, camera and animation; there may be no scene yet. */
  private async readScene(): Promise<void> {
    try {
      const info = await this.rpc.request("scene.info");
      const camera = await this.rpc.request("camera.get");
      this.scene.set(info);
      this.showProgress(null);
      this.camera.set(camera);
      this.onAnimationState(await this.rpc.request("animation.list"));
    } catch (error) {
      const noScene =
        error instanceof RpcError &&
        (error.code === ErrorCode.notReady || error.code === ErrorCode.notFound);
      if (!noScene) throw error;
    }
  }

  /** Does nothing where the server has no sessions. */
  private async readSession(): Promise<void> {
    try {
      this.setSession(await this.rpc.request("session.info"));
    } catch (error) {
      if (error instanceof ChannelClosed) throw error;
    }
  }

  /** All viewers get the same list; hello told which entry is this page. */
  private setSession(session: SessionInfo): void {
    const own = this.receivedHello?.viewer;
    const viewers = session.viewers.map((viewer) => ({ ...viewer, you: viewer.viewer === own }));
    this.session.set({ ...session, viewers });
    this.controlState.set(controlStateOf(this.session.value, this.receivedHello?.role));
    this.stream.onFrameSize(session);
    this.stream.updateSize();
  }

  private async sceneChanged(info: SceneInfo): Promise<void> {
    // During a restore this may be an intermediate scene.
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
    if (frame.codec === Codec.h264) this.stream.onVideoFrame();
    this.frame.set(frame);
  }

  private notified(method: string, params: unknown): void {
    switch (method) {
      case "settings.changed":
        this.settings.receive((params as Notifications["settings.changed"]).patch);
        break;
      case "camera.changed":
        if (this.pendingViewState || this.cameraBusy()) break;
        this.camera.set((params as Notifications["camera.changed"]).camera);
        break;
      case "animation.changed":
        if (this.pendingViewState) break;
        this.onAnimationState((params as Notifications["animation.changed"]).animation);
        break;
      case "scene.changed":
        void this.sceneChanged((params as Notifications["scene.changed"]).scene);
        break;
      case "session.changed":
        this.setSession(params as Notifications["session.changed"]);
        break;
      case "lights.changed":
      case "materials.changed":
      case "environment.changed":
        this.parts.notified(method, params);
        break;
      case "scene.progress":
        this.showProgress(params as Notifications["scene.progress"]);
        break;
      case "stats.frame":
        this.stats.set(params as Notifications["stats.frame"]);
        break;
    }
  }

  /** A failed load of another viewer sends no message, so the progress expires. */
  private showProgress(progress: SceneProgress | null): void {
    clearTimeout(this.progressTimer);
    this.loading.set(progress);
    if (progress) {
      this.progressTimer = window.setTimeout(() => this.loading.set(null), progressTimeoutMs);
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
