// Turns the camera around its target until the user moves it.

import type { CameraPose } from "../common/camera_pose.ts";
import { Signal } from "../common/signal.ts";
import { orbit } from "./camera.ts";

const turnsPerMs = (2 * Math.PI) / 30_000;
/** After a pause, as of a hidden page, the camera goes on where it was. */
const longestStepMs = 100;

export interface AutoRotateHost {
  /** Null where this page may not move the camera now. */
  camera(): CameraPose | null;
  moved(camera: CameraPose): void;
  /** Whether the user moves the camera. */
  isBusy(): boolean;
}

export class AutoRotate {
  readonly running = new Signal(false);
  private readonly host: AutoRotateHost;
  private steppedAt = 0;

  constructor(host: AutoRotateHost) {
    this.host = host;
  }

  toggle(): void {
    this.running.set(!this.running.value);
    if (!this.running.value) return;
    this.steppedAt = performance.now();
    requestAnimationFrame(this.step);
  }

  private readonly step = (now: number): void => {
    if (!this.running.value) return;
    const camera = this.host.camera();
    if (!camera || this.host.isBusy()) {
      this.running.set(false);
      return;
    }
    const elapsedMs = Math.min(longestStepMs, Math.max(0, now - this.steppedAt));
    this.steppedAt = now;
    this.host.moved(orbit(camera, turnsPerMs * elapsedMs, 0));
    requestAnimationFrame(this.step);
  };
}
