// Moves the camera along a path until it has arrived, or the user moves the camera.

import type { CameraPose } from "../common/camera_pose.ts";
import { Signal } from "../common/signal.ts";
import type { AutoRotateHost } from "./auto_rotate.ts";
import { type PathForm, cameraOnPath } from "./camera_path.ts";

export interface Path {
  keys: readonly CameraPose[];
  form: PathForm;
  /** From the first key to the last. */
  seconds: number;
}

export class PathPlayer {
  readonly running = new Signal(false);
  private readonly host: AutoRotateHost;
  private path: Path | null = null;
  private startedAt = 0;

  constructor(host: AutoRotateHost) {
    this.host = host;
  }

  play(path: Path): void {
    if (!this.host.camera()) return;
    this.path = path;
    this.startedAt = performance.now();
    this.running.set(true);
    requestAnimationFrame(this.step);
  }

  stop(): void {
    this.running.set(false);
  }

  private readonly step = (now: number): void => {
    const { path } = this;
    if (!this.running.value || !path) return;
    if (!this.host.camera() || this.host.isBusy()) {
      this.running.set(false);
      return;
    }
    const fraction = Math.max(0, now - this.startedAt) / (1000 * path.seconds);
    const arrived = fraction >= 1 && !path.form.closed;
    this.host.moved(cameraOnPath(path.keys, path.form, arrived ? 1 : fraction % 1));
    if (arrived) this.running.set(false);
    else requestAnimationFrame(this.step);
  };
}
