// Turns mouse, touch and keyboard input into camera poses: at most one per animation frame.

import type { Vector3 } from "heliograph/json.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import {
  dolly,
  dollyToPoint,
  fly,
  interpolate,
  look,
  orbit,
  orbitAround,
  pan,
  zoomTo,
} from "./camera.ts";
import { ZoomAnchor } from "./zoom_anchor.ts";

interface NavigationHost {
  /** The pose to start from; null while there is no scene. */
  camera(): CameraPose | null;
  /** Largest extent of the scene in metres; it limits the distance to the target. */
  sceneSize(): number;
  /** Takes the new pose, once per animation frame; `recorded` as a step of the history. */
  moved(camera: CameraPose, recorded: boolean, movement: number): void;
  fit(): void;
  /** The surface at a point, in fractions of the view's width and height; null where none is. */
  surfaceAt(x: number, y: number): Promise<Vector3 | null>;
  /** Focuses on the surface at a point, in fractions of the view's width and height. */
  focus(x: number, y: number): void;
}

type Gesture = "orbit" | "pan" | "pinch" | "look";
interface Point {
  x: number;
  y: number;
}

const orbitPerHeight = 1.5 * Math.PI; // radians for a drag over the height of the view
const inertiaMs = 110;
const minInertiaSpeed = 4e-5; // radians per millisecond
const keyOrbitPerMs = 1.3e-3;
const keyPanPerMs = 5e-4;
const keyDollyPerMs = 1.4e-3;
const firstKeyStepMs = 35;
const lookPerHeight = 0.6 * Math.PI; // radians for a drag over the height of the view
const flyPerMs = 2e-4; // scene sizes per millisecond
const fastFlyFactor = 4;
const transitionMs = 450;
/** How close the wheel brings the eye to a surface, as a part of the least distance to a target. */
const nearestSurface = 0.2;

const navigationKeys = new Set([
  "ArrowLeft",
  "ArrowRight",
  "ArrowUp",
  "ArrowDown",
  "+",
  "=",
  "-",
  "_",
]);

/** Key codes name the position on the keyboard, independent of its layout. */
const flyKeys: Record<string, [right: number, up: number, forward: number]> = {
  KeyW: [0, 0, 1],
  KeyS: [0, 0, -1],
  KeyA: [-1, 0, 0],
  KeyD: [1, 0, 0],
  KeyQ: [0, -1, 0],
  KeyE: [0, 1, 0],
};

export class Navigation {
  private readonly surface: HTMLElement;
  private readonly host: NavigationHost;
  private readonly reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
  private readonly pointers = new Map<number, Point>();
  private readonly heldKeys = new Set<string>();
  private readonly zoomAnchor: ZoomAnchor;
  private gesture: Gesture | null = null;
  /** The surface that was clicked; null: orbits about the target. */
  private pivot: Vector3 | null = null;
  private pendingPose: CameraPose | null = null;
  private frameRequest = 0;
  private lastFrameAt = 0;
  private lastMoveAt = 0;
  private inertia = { yaw: 0, pitch: 0 };
  private shiftHeld = false;
  /** The movement in progress is no step of the history. */
  private unrecorded = false;
  /** Number of the movement in progress, or the next one. */
  private movement = 0;
  private transition: { from: CameraPose; to: CameraPose; startedAt: number } | null = null;

  constructor(surface: HTMLElement, host: NavigationHost) {
    this.surface = surface;
    this.host = host;
    this.zoomAnchor = new ZoomAnchor(
      (x, y) => host.surfaceAt(x, y),
      (factor, point, at) => this.zoomAt(factor, point, at),
    );
    surface.addEventListener("pointerdown", this.pointerDown);
    surface.addEventListener("pointermove", this.pointerMove);
    surface.addEventListener("pointerup", this.pointerUp);
    surface.addEventListener("pointercancel", this.pointerUp);
    surface.addEventListener("wheel", this.wheel, { passive: false });
    surface.addEventListener("dblclick", this.doubleClick);
    surface.addEventListener("contextmenu", (event) => event.preventDefault());
    surface.addEventListener("mousedown", (event) => {
      if (event.button === 1) event.preventDefault(); // no automatic scrolling
    });
    addEventListener("keydown", this.keyDown);
    addEventListener("keyup", this.keyUp);
    addEventListener("blur", () => this.heldKeys.clear());
  }

  /** True while the user moves the camera. */
  get active(): boolean {
    const hasInput = this.pointers.size > 0 || this.heldKeys.size > 0;
    return hasInput || this.pendingPose !== null || this.transition !== null;
  }

  /** Moves to a pose in a short transition; at once if the user prefers reduced motion. */
  goTo(camera: CameraPose, recorded = true): void {
    const from = this.host.camera();
    if (!from) return;
    this.stopMotion();
    this.unrecorded = !recorded;
    if (this.reducedMotion.matches) this.change(() => camera);
    else this.transition = { from, to: camera, startedAt: performance.now() };
    this.schedule();
  }

  /** Ends the movement in progress: what is held moves nothing until it is pressed again. */
  stop(): void {
    this.stopMotion();
    this.pointers.clear();
    this.heldKeys.clear();
    this.pendingPose = null;
    this.gesture = null;
    this.movement += 1;
    this.surface.classList.remove("grabbing");
  }

  private get flying(): boolean {
    return [...this.heldKeys].some((key) => key in flyKeys);
  }

  private stopMotion(): void {
    this.zoomAnchor.forget();
    this.stopInertia();
  }

  private stopInertia(): void {
    this.inertia = { yaw: 0, pitch: 0 };
    this.transition = null;
    this.unrecorded = false;
  }

  private readonly pointerDown = (event: PointerEvent): void => {
    this.surface.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.stopMotion();
    if (this.pointers.size > 1) this.gesture = "pinch";
    else if (this.flying) this.gesture = "look";
    else this.gesture = event.button !== 0 || event.shiftKey ? "pan" : "orbit";
    this.pivot = null;
    if (this.gesture === "orbit") void this.findPivot(event);
    this.surface.classList.add("grabbing");
  };

  private readonly pointerMove = (event: PointerEvent): void => {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const after = { x: event.clientX, y: event.clientY };
    const height = this.surface.clientHeight || 1;
    const right = (after.x - before.x) / height;
    const down = (after.y - before.y) / height;
    if (this.gesture === "pinch") this.pinch(event.pointerId, before, after, height);
    else if (this.gesture === "pan") this.change((camera) => pan(camera, right, down));
    else if (this.gesture === "look") {
      this.change((camera) => look(camera, right * lookPerHeight, down * lookPerHeight));
    } else this.dragOrbit(right * orbitPerHeight, down * orbitPerHeight, event.timeStamp);
    this.pointers.set(event.pointerId, after);
  };

  private readonly pointerUp = (event: PointerEvent): void => {
    if (!this.pointers.delete(event.pointerId)) return;
    if (this.pointers.size > 0) {
      this.gesture = this.pointers.size > 1 ? "pinch" : "orbit";
      this.inertia = { yaw: 0, pitch: 0 };
      return;
    }
    const stoppedBeforeRelease = event.timeStamp - this.lastMoveAt > 60;
    if (this.gesture !== "orbit" || stoppedBeforeRelease || this.reducedMotion.matches) {
      this.inertia = { yaw: 0, pitch: 0 };
    }
    this.gesture = null;
    this.surface.classList.remove("grabbing");
    this.schedule();
  };

  /** Until the server has answered the view orbits about the target. */
  private async findPivot({ clientX, clientY, pointerId }: PointerEvent): Promise<void> {
    const { left, top, width, height } = this.surface.getBoundingClientRect();
    const at = { x: (clientX - left) / width, y: (clientY - top) / height };
    const surface = await this.host.surfaceAt(at.x, at.y);
    if (this.gesture === "orbit" && this.pointers.has(pointerId)) this.pivot = surface;
  }

  private orbit(camera: CameraPose, yaw: number, pitch: number): CameraPose {
    return this.pivot ? orbitAround(camera, this.pivot, yaw, pitch) : orbit(camera, yaw, pitch);
  }

  private dragOrbit(right: number, down: number, at: number): void {
    const elapsed = Math.max(4, Math.min(100, at - this.lastMoveAt));
    this.lastMoveAt = at;
    const blend = Math.min(1, elapsed / 40);
    this.inertia.yaw += (-right / elapsed - this.inertia.yaw) * blend;
    this.inertia.pitch += (down / elapsed - this.inertia.pitch) * blend;
    this.change((camera) => this.orbit(camera, -right, down));
  }

  /** Two fingers: their midpoint pans, their distance dollies. */
  private pinch(moving: number, before: Point, after: Point, height: number): void {
    const other = [...this.pointers].find(([id]) => id !== moving)?.[1];
    if (!other) return;
    const spread = Math.hypot(before.x - other.x, before.y - other.y);
    const spreadAfter = Math.hypot(after.x - other.x, after.y - other.y);
    const right = (after.x - before.x) / 2 / height;
    const down = (after.y - before.y) / 2 / height;
    this.change((camera) => {
      const moved = pan(camera, right, down);
      return spread > 8 && spreadAfter > 8 ? this.zoom(moved, spread / spreadAfter) : moved;
    });
  }

  private readonly wheel = (event: WheelEvent): void => {
    event.preventDefault();
    const unit = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    const pixels = Math.max(-240, Math.min(240, event.deltaY * unit));
    // Trackpads report a pinch as a wheel with ctrl, in much smaller steps.
    const rate = event.ctrlKey ? 0.01 : 0.0015;
    const { left, top, width, height } = this.surface.getBoundingClientRect();
    const at = { x: (event.clientX - left) / width, y: (event.clientY - top) / height };
    this.stopInertia();
    const surface = this.zoomAnchor.under(at.x, at.y);
    this.zoomAt(this.zoomAnchor.limit(Math.exp(pixels * rate)), surface, at);
  };

  /** Zooms to a surface or, where there is none, to a point of the view, in fractions of its size. */
  private zoomAt(factor: number, surface: Vector3 | null, at: Point): void {
    const { width, height } = this.surface.getBoundingClientRect();
    const right = ((at.x - 0.5) * width) / height;
    this.change((camera) => {
      const [nearest, farthest] = this.distances();
      return surface
        ? zoomTo(camera, factor, surface, [nearestSurface * nearest, farthest])
        : dollyToPoint(camera, factor, [nearest, farthest], right, at.y - 0.5);
    });
  }

  private readonly doubleClick = (event: MouseEvent): void => {
    const { left, top, width, height } = this.surface.getBoundingClientRect();
    this.host.focus((event.clientX - left) / width, (event.clientY - top) / height);
  };

  private readonly keyDown = (event: KeyboardEvent): void => {
    const elsewhere = event.target !== this.surface && event.target !== document.body;
    if (elsewhere || event.ctrlKey || event.metaKey || event.altKey) return;
    this.shiftHeld = event.shiftKey;
    const key = event.code in flyKeys ? event.code : event.key;
    if (event.key === "f" || event.key === "F") {
      this.host.fit();
    } else if (navigationKeys.has(key) || key in flyKeys) {
      if (!this.heldKeys.has(key) && !event.repeat) {
        this.stopMotion();
        this.heldKeys.add(key);
        this.applyKeys(firstKeyStepMs);
      }
    } else {
      return;
    }
    event.preventDefault();
  };

  private readonly keyUp = (event: KeyboardEvent): void => {
    this.shiftHeld = event.shiftKey;
    this.heldKeys.delete(event.key);
    this.heldKeys.delete(event.code);
  };

  private applyKeys(elapsedMs: number): void {
    const held = (...names: string[]): number => (names.some((n) => this.heldKeys.has(n)) ? 1 : 0);
    const right = held("ArrowRight") - held("ArrowLeft");
    const up = held("ArrowUp") - held("ArrowDown");
    const away = held("-", "_") - held("+", "=");
    this.change((camera) => {
      let moved = camera;
      if (this.shiftHeld && (right || up)) {
        moved = pan(moved, -right * keyPanPerMs * elapsedMs, up * keyPanPerMs * elapsedMs);
      } else if (right || up) {
        moved = orbit(moved, right * keyOrbitPerMs * elapsedMs, up * keyOrbitPerMs * elapsedMs);
      }
      if (away) moved = this.zoom(moved, Math.exp(away * keyDollyPerMs * elapsedMs));
      return this.flying ? this.applyFlyKeys(moved, elapsedMs) : moved;
    });
  }

  private applyFlyKeys(camera: CameraPose, elapsedMs: number): CameraPose {
    const metres =
      this.host.sceneSize() * flyPerMs * elapsedMs * (this.shiftHeld ? fastFlyFactor : 1);
    const offset = [0, 0, 0] as [number, number, number];
    for (const key of this.heldKeys) {
      flyKeys[key]?.forEach((direction, axis) => (offset[axis as 0 | 1 | 2] += direction * metres));
    }
    return fly(camera, ...offset);
  }

  /** Limits of the distance to the target, metres. */
  private distances(): [nearest: number, farthest: number] {
    const size = this.host.sceneSize();
    return [0.02 * size, 20 * size];
  }

  private zoom(camera: CameraPose, factor: number): CameraPose {
    return dolly(camera, factor, ...this.distances());
  }

  private change(move: (camera: CameraPose) => CameraPose): void {
    const camera = this.pendingPose ?? this.host.camera();
    if (!camera) return;
    this.pendingPose = move(camera);
    this.schedule();
  }

  private schedule(): void {
    if (this.frameRequest) return;
    this.lastFrameAt = performance.now();
    this.frameRequest = requestAnimationFrame(this.frame);
  }

  private readonly frame = (now: number): void => {
    this.frameRequest = 0;
    const elapsed = Math.min(100, Math.max(0, now - this.lastFrameAt));
    if (this.heldKeys.size > 0) this.applyKeys(elapsed);
    const moving =
      this.continueTransition(now) || (this.pointers.size === 0 && this.continueInertia(elapsed));
    if (this.pendingPose) {
      const camera = this.pendingPose;
      this.pendingPose = null;
      this.host.moved(camera, !this.unrecorded, this.movement);
    }
    if (!moving && this.heldKeys.size === 0 && this.pointers.size === 0) this.movement += 1;
    if (moving || this.heldKeys.size > 0) {
      cancelAnimationFrame(this.frameRequest);
      this.lastFrameAt = now;
      this.frameRequest = requestAnimationFrame(this.frame);
    }
  };

  private continueTransition(now: number): boolean {
    if (!this.transition) return false;
    const { from, to, startedAt } = this.transition;
    const t = Math.min(1, Math.max(0, (now - startedAt) / transitionMs));
    this.pendingPose = interpolate(from, to, t * t * (3 - 2 * t));
    if (t >= 1) this.transition = null;
    return t < 1;
  }

  private continueInertia(elapsedMs: number): boolean {
    const { yaw, pitch } = this.inertia;
    if (Math.hypot(yaw, pitch) < minInertiaSpeed) {
      this.inertia = { yaw: 0, pitch: 0 };
      return false;
    }
    this.change((camera) => this.orbit(camera, yaw * elapsedMs, pitch * elapsedMs));
    const decay = Math.exp(-elapsedMs / inertiaMs);
    this.inertia = { yaw: yaw * decay, pitch: pitch * decay };
    return true;
  }
}
