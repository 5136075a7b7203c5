// Movements of the session's camera by this page, and their steps in the history.

import type { SceneInfo } from "heliograph/messages.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import type { Signal } from "../common/signal.ts";
import type { LatencyMeter } from "../stream/latency.ts";
import { clockMs } from "../stream/worker_messages.ts";
import type { UndoHistory } from "./history/undo_history.ts";

interface CameraMovesHost {
  rpc: RpcPeer;
  camera: Signal<CameraPose | null>;
  scene: Signal<SceneInfo | null>;
  latency: LatencyMeter;
  history: UndoHistory;
  /** Whether movements are steps of the history: not those of a camera of one's own. */
  records(): boolean;
  /** A camera of one's own that was another viewer's is so no longer. */
  begins(): void;
  /** The user has moved the camera; `seq` numbers the message to the server. */
  moved(camera: CameraPose, seq: number): void;
  /** Another scene is seen: what was moved last is not its camera. */
  left(): void;
  attempt(action: () => Promise<unknown>): Promise<void>;
}

export class CameraMoves {
  /** Moves to a pose in a visible transition; `recorded` as a step of the history. */
  animateTo: (camera: CameraPose, recorded?: boolean) => void = (camera, recorded) =>
    this.moveTo(camera, recorded);
  /** True while the user moves the camera; poses of other viewers are then ignored. */
  isBusy: () => boolean = () => false;
  /** Ends the movement in progress. */
  stop: () => void = () => {};
  place: (camera: CameraPose) => CameraPose = (camera) => camera;
  private readonly host: CameraMovesHost;
  private inputSeq = 0;
  /** Of the scene whose camera the page has; null: it has none yet. */
  private sceneRev: number | null = null;

  constructor(host: CameraMovesHost) {
    this.host = host;
  }

  /** A new connection counts inputs from the start. */
  reset(): void {
    this.inputSeq = 0;
    this.forgetScene();
  }

  /** Another session counts its own revisions. */
  forgetScene(): void {
    this.sceneRev = null;
  }

  /**
   * The server tells this camera. Where it is one of another scene, no movement of the one before
   * goes on. Whether it is.
   */
  arrived({ scene_rev }: CameraPose): boolean {
    if (scene_rev === undefined || scene_rev === this.sceneRev) return false;
    const isOther = this.sceneRev !== null;
    this.sceneRev = scene_rev;
    if (!isOther) return false;
    this.stop();
    this.host.left();
    return true;
  }

  /** Sends an absolute pose of a movement. Call at most once per animation frame. */
  moveTo(camera: CameraPose, recorded = true, movement?: number): void {
    this.host.begins();
    if (recorded) this.remember(camera, movement);
    this.host.camera.set(camera);
    const seq = this.nextInput();
    this.host.moved(camera, seq);
    const { eye, target, up, vertical_fov } = camera;
    const scene_rev = this.sceneRev ?? undefined;
    this.host.rpc.notify("camera.set", { eye, target, up, vertical_fov, seq, scene_rev });
  }

  /** Selects a camera of the scene. */
  async select(name: string, recorded = true): Promise<void> {
    await this.host.attempt(async () => {
      this.host.begins();
      const camera = await this.host.rpc.request("camera.set", { name, seq: this.nextInput() });
      this.arrived(camera);
      if (recorded) this.remember(camera);
      this.host.camera.set(camera);
    });
  }

  /** Fits the scene, or these nodes of it, into the view; `place` adapts the pose to what covers the view. */
  async fit(nodes?: number[], recorded = true): Promise<void> {
    await this.host.attempt(async () => {
      this.host.begins();
      const camera = await this.host.rpc.request("camera.fit", nodes ? { nodes } : {});
      this.arrived(camera);
      const placed = this.place(camera);
      if (recorded) this.remember(placed);
      this.host.camera.set(camera);
      if (placed !== camera) this.moveTo(placed, false);
    });
  }

  private nextInput(): number {
    this.inputSeq += 1;
    this.host.latency.inputSent(this.inputSeq, clockMs());
    return this.inputSeq;
  }

  private remember(camera: CameraPose, movement?: number): void {
    const before = this.host.camera.value;
    if (!before || !this.host.records()) return;
    this.host.history.add({
      label: "camera",
      key: "camera",
      movement,
      ofScene: true,
      undo: () => this.returnTo(before),
      redo: () => this.returnTo(camera),
    });
  }

  private returnTo(camera: CameraPose): void {
    const { name } = camera;
    const named = name !== null && this.host.scene.value?.cameras.includes(name);
    if (named) void this.select(name, false);
    else this.animateTo(camera, false);
  }
}
