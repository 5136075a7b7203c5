// The session that this page shows, and the calls that change it. No DOM here except the canvas
// that the frames are drawn to.

import { Codec } from "heliograph/frame_header.ts";
import type { FrameStats, Hello, SceneInfo, SessionInfo } from "heliograph/messages.ts";
import { ChannelClosed, RpcError, type RpcPeer } from "heliograph/rpc.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import { Signal } from "../common/signal.ts";
import { UploadLists } from "../common/uploads.ts";
import { CanvasPainter } from "../stream/canvas_painter.ts";
import { Connection } from "../stream/connection.ts";
import { FrameMeters } from "../stream/frame_meters.ts";
import { type DrawnFrame, clockMs } from "../stream/worker_messages.ts";
import { type Activity, activityOf } from "./activity.ts";
import { Bookmarks } from "./bookmarks.ts";
import { CameraMoves } from "./camera_moves.ts";
import { Company } from "./company/company.ts";
import type { FileError } from "./file_errors.ts";
import { FrameQueries } from "./frame_queries.ts";
import { HandleChoice } from "./handle_choice.ts";
import { Marks } from "./marks/marks.ts";
import { Membership } from "./membership.ts";
import { NodeStore } from "./node_store.ts";
import { receiveNotification } from "./notifications.ts";
import { OwnSession } from "./own_session.ts";
import { SceneLoading } from "./scene_loading.ts";
import { SceneParts } from "./scene_parts.ts";
import { Textures } from "./edits/textures.ts";
import { ServerCapabilities } from "./server_capabilities.ts";
import { SectionStore } from "./section_store.ts";
import { SessionRestore } from "./session_restore.ts";
import { SettingsStore } from "./settings_store.ts";
import { ShownScene } from "./shown_scene.ts";
import { StreamRequests } from "./stream_requests.ts";
import { UndoHistory } from "./history/undo_history.ts";
import { ViewRestore } from "./view_restore.ts";
import { type ViewState, changesOf } from "./view_state.ts";

const statsIntervalMs = 250;

export const bufferSetting = "view.buffer";

export class Viewer {
  readonly connection: Connection;
  readonly rpc: RpcPeer;
  readonly settings: SettingsStore;
  readonly capabilities: ServerCapabilities;
  readonly parts: SceneParts;
  readonly textures: Textures;
  readonly nodes: NodeStore;
  readonly section: SectionStore;
  readonly handles: HandleChoice;
  readonly stream: StreamRequests;
  readonly queries: FrameQueries;
  readonly bookmarks: Bookmarks;
  readonly marks: Marks;
  readonly own: OwnSession;
  readonly history = new UndoHistory();
  readonly uploads = new UploadLists(this);
  readonly loading: SceneLoading;
  readonly cameraMoves: CameraMoves;
  readonly membership: Membership;
  readonly company: Company;
  readonly restoring: Signal<boolean>;
  readonly shown = new ShownScene({
    rpc: () => this.rpc,
    awaitFrame: (rev) => this.awaitFirstFrame(rev),
    cameraArrived: (camera) => this.cameraMoves.arrived(camera),
    fit: () => this.cameraMoves.fit(undefined, false),
    mayMove: () => this.membership.mayMove,
    isRestoring: () => this.viewRestore.pending !== null,
    attempt: (action) => this.attempt(action),
    changedAt: (rev) => this.capabilities.changedAt(rev),
  });
  readonly scenes = this.shown.list;
  readonly scene = this.shown.scene;
  readonly camera = this.shown.camera;
  readonly animation = this.shown.animation;
  /** What another viewer has changed last. */
  readonly activity = new Signal<Activity | null>(null);
  readonly stats = new Signal<FrameStats | null>(null);
  readonly frame = new Signal<DrawnFrame | null>(null);
  readonly meters = new FrameMeters();
  /** Where a point of the view lies in the frame, both in fractions of width and height. */
  inFrame: (x: number, y: number) => { x: number; y: number } = (x, y) => ({ x, y });
  /** Shows an error as one sentence. */
  onError: (message: string) => void = () => {};
  /** Shows why a scene file was not loaded. */
  onFileError: (error: FileError) => void = () => {};
  /** Shows other news as one sentence; newer ones of a topic replace older ones. */
  onInfo: (message: string, topic?: string) => void = () => {};
  /** Starts or stops the clip. */
  togglePlay: () => void = () => {};
  /** Stores the current view as a bookmark. */
  addBookmark: () => void = () => {};
  /** From the arrival of the server's hello until the connection is lost. */
  private receivedHello: Hello | null = null;
  readonly viewRestore: ViewRestore;
  private readonly sessionRestore: SessionRestore;

  constructor(base: string, canvas: HTMLCanvasElement) {
    const offscreen =
      typeof canvas.transferControlToOffscreen === "function"
        ? canvas.transferControlToOffscreen()
        : null;
    const painter = offscreen ? null : new CanvasPainter(canvas);
    this.connection = new Connection(base, offscreen, {
      prepare: () => this.own.prepare(),
      sessionMissing: () => this.own.planReplacement(this.scene.value ? this.viewState() : null),
      live: (hello) => this.becomeLive(hello),
      notification: (method, params) => this.notified(method, params),
      drawn: (frame) => this.frameDrawn(frame),
      draw: (image, frame) => painter?.draw(image, frame.width, frame.height),
      predicted: (seq, drawnAt) => this.meters.predicted(seq, drawnAt),
      cannotPredict: () => this.stream.request({ depth: false }),
      warning: (message) => this.onError(message),
      decodeFailed: (message, video) => {
        if (video) this.stream.onVideoError();
        else this.onError(`A frame could not be shown: ${message}`);
      },
    });
    this.rpc = this.connection.rpc;
    this.membership = new Membership({
      rpc: this.rpc,
      hello: () => this.receivedHello,
      changed: (session) => {
        if (!this.membership.mayMove) this.connection.predict(null);
        this.stream.onFrameSize(session);
        this.stream.updateSize();
      },
      moved: () => this.sessionMoved(),
      attempt: (action) => this.attempt(action),
    });
    this.own = new OwnSession({
      address: this.connection.address,
      current: () => this.receivedHello?.session ?? null,
      reconnect: () => this.changeSession(),
      show: (view) => (this.viewRestore.pending = view),
      refused: (sentence) => this.onError(sentence),
      inform: (sentence) => this.onInfo(sentence),
    });
    this.loading = new SceneLoading({
      rpc: this.rpc,
      history: this.history,
      viewer: () => this.receivedHello?.viewer ?? "",
      viewState: () => (this.scene.value ? this.viewState() : null),
      isRestoring: () => this.viewRestore.pending !== null,
      show: (view) => void this.viewRestore.show(view),
      reportFile: (error) => this.onFileError(error),
      sceneChanged: (info) => this.ownSceneArrived(info),
      report: (error) => this.report(error),
      inform: (sentence) => this.onInfo(sentence),
    });
    this.cameraMoves = new CameraMoves({
      rpc: this.rpc,
      camera: this.camera,
      records: () => this.mayChange,
      begins: () => this.membership.unfollowed(),
      scene: this.scene,
      latency: this.meters.latency,
      history: this.history,
      moved: (camera, seq) => {
        if (this.viewRestore.pending) this.viewRestore.pending.camera = camera;
        const { eye, target, up, vertical_fov } = camera;
        this.connection.predict({ eye, target, up, vertical_fov, seq });
        this.meters.responses.inputSent(seq, clockMs());
      },
      left: () => {
        this.connection.predict(null);
        this.history.leaveScene();
      },
      attempt: (action) => this.attempt(action),
    });
    this.settings = new SettingsStore(this.rpc, this.history, (error) => this.report(error));
    this.capabilities = new ServerCapabilities(this.rpc);
    this.textures = new Textures({
      rpc: this.rpc,
      scene: this.scene,
      capabilities: this.capabilities,
      history: this.history,
      loading: this.loading,
      report: (error) => this.report(error),
      changed: () => void this.parts.read(),
    });
    this.parts = new SceneParts({
      rpc: this.rpc,
      scene: this.scene,
      capabilities: this.capabilities,
      history: this.history,
      loading: this.loading,
      shows: (edits) => {
        this.nodes.notified("nodes.changed", edits);
        void this.section.read();
        void this.textures.read();
      },
      report: (error) => this.report(error),
    });
    this.nodes = new NodeStore(this);
    this.section = new SectionStore(this);
    this.handles = new HandleChoice(this);
    const marks = {
      rpc: this.rpc,
      capabilities: this.capabilities,
      scene: this.scene,
      animation: this.animation,
      history: this.history,
      isRestoring: () => this.viewRestore.pending !== null,
      attempt: (action: () => Promise<unknown>) => this.attempt(action),
    };
    this.bookmarks = new Bookmarks(marks);
    this.marks = new Marks(marks);
    this.queries = new FrameQueries({
      rpc: this.rpc,
      capabilities: this.capabilities,
      buffer: () => String(this.settings.value(bufferSetting) ?? "output"),
      inFrame: (x, y) => this.inFrame(x, y),
      report: (error) => this.report(error),
    });
    this.company = new Company(this);
    this.sessionRestore = new SessionRestore({
      origin: () => this.connection.origin,
      mayChange: () => this.mayChange,
      viewState: () => (this.scene.value ? this.viewState() : null),
      clearScene: () => this.scene.set(null),
      arrivedAt: (origin, instanceChanged) => {
        this.connection.origin = origin;
        this.own.movedTo(origin);
        if (instanceChanged) void this.connection.persistRoute(origin);
      },
      inform: (sentence) => this.onInfo(sentence),
    });
    this.viewRestore = new ViewRestore({
      rpc: this.rpc,
      settings: this.settings,
      capabilities: this.capabilities,
      controlState: this.membership.controlState,
      hello: () => this.receivedHello,
      ownsSession: (hello) =>
        this.own.name === hello.session || this.sessionRestore.ownsSession(hello),
      begins: () => {
        if (this.connection.state.value.kind !== "live") this.frame.set(null);
      },
      arrived: (hello) => this.viewArrived(hello),
      reportSkipped: (sentence) => this.onError(sentence),
      reportFile: (error) => this.onFileError(error),
      inform: (sentence) => this.onInfo(sentence),
    });
    this.restoring = this.viewRestore.running;
    this.stream = new StreamRequests(this.rpc, {
      mayResize: () => this.membership.mayMove,
      report: (error) => this.report(error),
      inform: (sentence) => this.onInfo(sentence),
    });
    this.connection.state.watch(({ kind }) => {
      if (kind === "live") return;
      this.receivedHello = null;
      this.membership.unfollowed();
      this.company.pointers.forget(true);
      this.loading.reset();
      this.capabilities.reset();
      this.stream.end();
      // The first frames of a new connection may have another size or view.
      this.connection.hold();
    });
    this.settings.rev.watch((rev) => {
      if (rev > 0) void this.attempt(() => this.capabilities.changedAt(rev));
    });
  }

  get hello(): Hello | null {
    const state = this.connection.state.value;
    return state.kind === "live" ? state.hello : null;
  }

  get mayChange(): boolean {
    return this.membership.mayChange;
  }

  get mayCreateSessions(): boolean {
    return this.receivedHello?.role === "control" && this.capabilities.has("session.create");
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
      textures: this.textures.edits(),
      nodes: this.nodes.shown(),
      section: this.section.state(),
      settings: changesOf(this.settings.schema.value, this.settings.tree.value),
      clip: this.shown.clip(),
      // What is seen of a scene that is being loaded has a camera of its own.
      camera: this.loading.seesAnother ? undefined : (this.camera.value ?? undefined),
    };
  }

  private changeSession(): void {
    this.viewRestore.pending = null;
    this.scene.set(null);
    this.frame.set(null);
    this.history.clear();
    this.connection.reopen();
  }

  undo(): void {
    this.takeStep("Undo", "Undone", () => this.history.undo());
  }

  redo(): void {
    this.takeStep("Redo", "Done again", () => this.history.redo());
  }

  private takeStep(name: string, past: string, step: () => Promise<string | null>): void {
    const take = async (): Promise<void> => {
      const label = this.hello && this.mayChange ? await step() : null;
      if (label) this.onInfo(`${past}: ${label}`, "history");
    };
    this.history.whenKnown(
      () => void take(),
      () => this.onInfo(`${name} waits for the server's answer`, "history"),
    );
  }

  report(error: unknown): void {
    if (error instanceof ChannelClosed) return;
    this.onError(error instanceof RpcError ? error.sentence : (error as Error).message);
  }

  private async becomeLive(hello: Hello): Promise<void> {
    this.receivedHello = hello;
    this.meters.reset();
    this.cameraMoves.reset();
    this.shown.restart();
    await this.membership.read();
    // The server refuses to close it while other viewers are in it.
    const abandoned = this.own.takeAbandoned();
    if (abandoned !== null) this.rpc.notify("session.close", { session: abandoned });
    const restore = this.viewRestore;
    restore.pending = this.sessionRestore.pendingStateFor(hello, restore.pending);
    restore.dropWithoutControl();
    await Promise.all([
      this.stream.begin(hello, restore.pending !== null),
      this.settings.load(),
      this.shown.readList(),
      this.attempt(() => this.capabilities.readBuffers()),
      this.attempt(() => this.capabilities.read()),
      this.attempt(() => this.rpc.request("stats.subscribe", { interval_ms: statsIntervalMs })),
    ]);
    if (restore.pending) {
      void this.attempt(() => restore.restore());
    } else {
      this.connection.release({ oldestRev: 0, size: this.stream.requestedSize });
      await this.shown.read();
      if (this.membership.isAlone) await this.shown.fitFirstView();
      void this.bookmarks.read();
      this.marks.read();
      this.sessionRestore.arrived(hello);
    }
  }

  /** A whole view state is in effect. */
  private async viewArrived(hello: Hello): Promise<void> {
    this.sessionRestore.arrived(hello);
    await Promise.all([this.settings.load(), this.shown.readList(), this.shown.read()]);
    if (this.mayChange) void this.bookmarks.restore().then(() => this.marks.restore());
    this.connection.release({ oldestRev: this.camera.value?.rev ?? 0 });
    await this.stream.resume();
  }

  setSession(session: SessionInfo): void {
    this.membership.take(session);
  }

  leftBehind(): void {
    const { following } = this.membership;
    const name = following.value?.name;
    this.membership.unfollowed();
    if (name) this.onInfo(`${name} has left this view. You look around on your own.`);
  }

  /** The session that the page is in now has another camera, and counts its own revisions. */
  private async sessionMoved(): Promise<void> {
    this.connection.predict(null);
    this.company.pointers.forget(false);
    this.shown.restart();
    this.cameraMoves.forgetScene();
    this.loading.reset();
    this.capabilities.reset();
    this.stream.sessionChanged();
    await this.shown.read();
    await this.capabilities.changedAt(this.camera.value?.rev ?? 0);
    void this.bookmarks.read();
    this.marks.read();
  }

  /** A scene that this page has loaded. */
  private async ownSceneArrived(info: SceneInfo): Promise<void> {
    await this.shown.change(info);
    await this.shown.fitFirstView();
  }

  private frameDrawn(frame: DrawnFrame): void {
    this.meters.frameDrawn(frame);
    if (frame.codec === Codec.h264) this.stream.onVideoFrame();
    this.loading.frameDrawn(frame.stateRev);
    this.frame.set(frame);
    void this.attempt(() => this.capabilities.frameDrawn(frame.stateRev));
  }

  /** In lockstep no frame comes before the next step. */
  private awaitFirstFrame(rev: number): void {
    if (this.animation.value?.lockstep) this.loading.end();
    else this.loading.takesEffect(rev);
  }

  private notified(method: string, params: unknown): void {
    const { session } = this.membership;
    const activity = activityOf(method, params, session.value, this.settings.schema.value);
    if (activity) this.activity.set(activity);
    receiveNotification(this, method, params);
  }

  /** Another viewer has moved the camera, or another scene is seen. */
  takeCamera(camera: CameraPose): void {
    if (this.viewRestore.pending) return;
    if (!this.cameraMoves.arrived(camera) && this.cameraMoves.isBusy()) return;
    this.connection.predict(null);
    this.camera.set(camera);
  }

  private async attempt(action: () => Promise<unknown>): Promise<void> {
    try {
      await action();
    } catch (error) {
      this.report(error);
    }
  }
}
