// Loads scenes, and tells what is being loaded: from the request up to the first frame that shows
// it.

import { ErrorCode, type SceneInfo, type SceneProgress } from "heliograph/messages.ts";
import { ChannelClosed, RpcError, type RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import { type FileError, describeLoadError } from "./file_errors.ts";
import type { UndoHistory } from "./history/undo_history.ts";
import type { ViewState } from "./view_state.ts";

export interface Loading {
  kind: "scene" | "environment" | "texture";
  name: string;
  stage: string;
  /** In [0, 1]. */
  fraction: number;
  /** The viewer that loads it. */
  by: string;
  /** Whether the newest frame shows it already, without its textures. */
  firstView?: boolean;
}

/** One of several scenes of a file, and its material variant. */
interface ScenePart {
  scene?: string;
  variant?: string;
}

interface SceneLoadingHost {
  rpc: RpcPeer;
  history: UndoHistory;
  /** This page's id. */
  viewer(): string;
  /** What the page shows; null while it shows no scene. */
  viewState(): ViewState | null;
  /** Whether a whole view is being restored, whose steps are none of the history. */
  isRestoring(): boolean;
  show(state: ViewState): void;
  sceneChanged(scene: SceneInfo): Promise<void>;
  reportFile(error: FileError): void;
  report(error: unknown): void;
  inform(sentence: string): void;
}

/** The stage between the end of loading and the first frame. */
export const firstFrameStage = "first frame";
const finalStages = ["ready", "cancelled", "failed"];
const loadTimeoutMs = 600_000;

export class SceneLoading {
  readonly current = new Signal<Loading | null>(null);
  private readonly host: SceneLoadingHost;
  private newestRev = 0;
  private awaitedRev = 0;
  /** The newest revision before frames that show the scene without its textures. */
  private revBeforeFirstView: number | null = null;

  constructor(host: SceneLoadingHost) {
    this.host = host;
  }

  async load(name: string, part: ScenePart = {}, recorded = true): Promise<void> {
    const { host } = this;
    const before = host.viewState();
    this.start({ kind: "scene", name, stage: "starting", fraction: 0, by: host.viewer() });
    try {
      const info = await host.rpc.request("scene.load", { name, ...part }, loadTimeoutMs);
      const step = before && {
        label: `scene ${name}`,
        key: `scene ${name} ${JSON.stringify(part)}`,
        undo: () => host.show(before),
        redo: () => void this.load(name, part, false),
      };
      host.history.keepScene(recorded ? step : null);
      await host.sceneChanged(info);
    } catch (error) {
      this.failed(name, error);
    }
  }

  /** Cancels the running load. */
  async cancel(): Promise<void> {
    await this.host.rpc.request("scene.cancel").catch((error: unknown) => this.host.report(error));
  }

  start(loading: Loading): void {
    this.awaitedRev = 0;
    this.current.set(loading);
  }

  progressed({ name, stage, fraction, first_view, by }: SceneProgress): void {
    if (finalStages.includes(stage)) {
      if (stage !== "ready") this.leave();
      return;
    }
    if (first_view) this.enter();
    else this.leaveFirstView();
    this.start({ kind: "scene", name, stage, fraction, by, firstView: this.seesFirstView() });
  }

  /** Whether viewers see another scene than that of the session. */
  get seesAnother(): boolean {
    return this.revBeforeFirstView !== null;
  }

  private enter(): void {
    this.revBeforeFirstView ??= this.newestRev;
    if (!this.host.isRestoring()) this.host.history.enterScene();
  }

  private leaveFirstView(): void {
    this.revBeforeFirstView = null;
    this.host.history.leaveScene();
  }

  /** The load has failed or was cancelled. */
  private leave(): void {
    this.leaveFirstView();
    this.end();
  }

  private seesFirstView(): boolean {
    return this.revBeforeFirstView !== null && this.newestRev > this.revBeforeFirstView;
  }

  /** It is in effect from this revision of the session on: waits for a frame of it. */
  takesEffect(rev: number): void {
    this.revBeforeFirstView = null;
    const { value } = this.current;
    if (!value) return;
    if (this.newestRev >= rev) return this.end();
    this.awaitedRev = rev;
    this.current.set({ ...value, stage: firstFrameStage, fraction: 1 });
  }

  frameDrawn(stateRev: number): void {
    this.newestRev = stateRev;
    const { value } = this.current;
    if (this.awaitedRev > 0 && stateRev >= this.awaitedRev) this.end();
    else if (value && !value.firstView && this.seesFirstView()) {
      this.current.set({ ...value, firstView: true });
    }
  }

  end(): void {
    this.awaitedRev = 0;
    this.revBeforeFirstView = null;
    if (this.current.value) this.current.set(null);
  }

  /** A texture is not set after all; a scene that is loaded by now goes on. */
  endTexture(): void {
    if (this.current.value?.kind === "texture") this.end();
  }

  /** Revisions of another session are not comparable. */
  reset(): void {
    this.newestRev = 0;
    this.leave();
  }

  /** A load that was cancelled, or replaced by another one, is no error. */
  private failed(name: string, error: unknown): void {
    if (this.current.value?.name === name) this.end();
    if (error instanceof ChannelClosed) return;
    const conflict = error instanceof RpcError && error.code === ErrorCode.conflict;
    if (!conflict) this.host.reportFile(describeLoadError(name, error));
    else if (!this.current.value) this.host.inform(`Cancelled: ${name} was not loaded.`);
  }
}
