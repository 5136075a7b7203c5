// The scene of the session, its camera and its clip, as the server tells them.

import {
  type AnimationState,
  type SceneInfo,
  type SceneList,
  ErrorCode,
} from "heliograph/messages.ts";
import { RpcError, type RpcPeer } from "heliograph/rpc.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import { Signal } from "../common/signal.ts";
import { length, subtract } from "../common/vector.ts";
import { type ViewState, clipState } from "./view_state.ts";

interface ShownSceneHost {
  rpc(): RpcPeer;
  /** Frames of this revision are the first of what was read. */
  awaitFrame(rev: number): void;
  /** The camera that was read, before it is shown. */
  cameraArrived(camera: CameraPose): void;
  /** The camera that the server has fitted is to be fitted into what the page shows of a frame. */
  fit(): Promise<void>;
  mayMove(): boolean;
  isRestoring(): boolean;
  attempt(action: () => Promise<unknown>): Promise<void>;
  /** Revision of the camera of a scene that has changed. */
  changedAt(rev: number): Promise<unknown>;
}

export class ShownScene {
  readonly list = new Signal<SceneList>({ scenes: [], current: null });
  readonly scene = new Signal<SceneInfo | null>(null);
  readonly camera = new Signal<CameraPose | null>(null);
  readonly animation = new Signal<AnimationState | null>(null);
  private readonly host: ShownSceneHost;
  private animationReadAt = 0;
  private animationRev = 0;

  constructor(host: ShownSceneHost) {
    this.host = host;
    this.animation.watch(() => (this.animationReadAt = Date.now()));
  }

  /** Largest extent of the scene in metres; 1 while it is unknown. */
  get size(): number {
    const bounds = this.scene.value?.bounds;
    const size = bounds ? length(subtract(bounds.max, bounds.min)) : 0;
    return size > 0 && Number.isFinite(size) ? size : 1;
  }

  clip(): ViewState["clip"] {
    return clipState(this.animation.value, this.animationReadAt);
  }

  /** Another session or server counts its own revisions. */
  restart(): void {
    this.animationRev = 0;
  }

  /** Takes the state of the animation, unless a newer one came before. */
  takeAnimation(animation: AnimationState): void {
    if (animation.rev < this.animationRev) return;
    this.animationRev = animation.rev;
    this.animation.set(animation);
  }

  async readList(): Promise<void> {
    await this.host.attempt(async () => {
      this.list.set(await this.host.rpc().request("scene.list"));
    });
  }

  /** Reads scene, camera and animation; there may be no scene yet. */
  async read(): Promise<void> {
    const rpc = this.host.rpc();
    try {
      const info = await rpc.request("scene.info");
      const camera = await rpc.request("camera.get");
      this.host.cameraArrived(camera);
      this.scene.set(info);
      this.camera.set(camera);
      this.host.awaitFrame(camera.rev);
      this.takeAnimation(await rpc.request("animation.list"));
    } catch (error) {
      const noScene =
        error instanceof RpcError &&
        (error.code === ErrorCode.notReady || error.code === ErrorCode.notFound);
      if (!noScene) throw error;
    }
  }

  async change(info: SceneInfo): Promise<void> {
    // During a restore this may be an intermediate scene.
    if (this.host.isRestoring()) return;
    this.scene.set(info);
    this.list.set({ ...this.list.value, current: info.name });
    await this.host.attempt(() => this.read());
    const rev = this.camera.value?.rev ?? 0;
    await this.host.attempt(() => this.host.changedAt(rev));
  }

  /** What the server has fitted into an earlier frame is fitted into what this page shows of it. */
  async fitFirstView(): Promise<void> {
    const lockstep = this.animation.value?.lockstep ?? false;
    if (!this.host.mayMove() || this.host.isRestoring() || lockstep) return;
    const camera = await this.host.rpc().request("camera.get").catch(() => null);
    if (camera?.fitted) await this.host.fit();
  }
}
