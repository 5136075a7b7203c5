// Mouse, touch and keyboard to camera poses: at most one absolute pose per animation frame.

import type { Camera } from "../protocol/messages.ts";
import { dolly, orbit, pan } from "./camera.ts";

export interface NavigationHost {
  /** The pose to start from; null while there is no scene. */
  camera(): Camera | null;
  /** Largest extent of the scene in metres; bounds how near and far one can go. */
  sceneSize(): number;
  /** Takes the new pose, once per animation frame. */
  moved(camera: Camera): void;
  fit(): void;
}

type Gesture = "orbit" | "pan" | "pinch";
interface Point {
  x: number;
  y: number;
}

const orbitPerHeight = 1.5 * Math.PI; // radians for a drag over the height of the view
const inertiaMs = 110;
const slowestGlide = 4e-5; // radians per millisecond
const keyOrbitPerMs = 1.3e-3;
const keyPanPerMs = 5e-4;
const keyDollyPerMs = 1.4e-3;
const firstKeyStepMs = 35;

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

export class Navigation {
  private readonly surface: HTMLElement;
  private readonly host: NavigationHost;
  private readonly reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");
  private readonly pointers = new Map<number, Point>();
  private readonly heldKeys = new Set<string>();
  private gesture: Gesture | null = null;
  private next: Camera | null = null;
  private frameRequest = 0;
  private lastFrameAt = 0;
  private lastMoveAt = 0;
  private glide = { yaw: 0, pitch: 0 };
  private shiftHeld = false;

  constructor(surface: HTMLElement, host: NavigationHost) {
    this.surface = surface;
    this.host = host;
    surface.addEventListener("pointerdown", this.pointerDown);
    surface.addEventListener("pointermove", this.pointerMove);
    surface.addEventListener("pointerup", this.pointerUp);
    surface.addEventListener("pointercancel", this.pointerUp);
    surface.addEventListener("wheel", this.wheel, { passive: false });
    surface.addEventListener("contextmenu", (event) => event.preventDefault());
    surface.addEventListener("mousedown", (event) => {
      if (event.button === 1) event.preventDefault(); // no automatic scrolling
    });
    addEventListener("keydown", this.keyDown);
    addEventListener("keyup", this.keyUp);
    addEventListener("blur", () => this.heldKeys.clear());
  }

  /** True while a hand is on the camera; poses from elsewhere should wait. */
  get active(): boolean {
    return this.pointers.size > 0 || this.heldKeys.size > 0 || this.next !== null;
  }

  private readonly pointerDown = (event: PointerEvent): void => {
    this.surface.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.glide = { yaw: 0, pitch: 0 };
    if (this.pointers.size > 1) this.gesture = "pinch";
    else this.gesture = event.button !== 0 || event.shiftKey ? "pan" : "orbit";
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
    else this.dragOrbit(right * orbitPerHeight, down * orbitPerHeight, event.timeStamp);
    this.pointers.set(event.pointerId, after);
  };

  private readonly pointerUp = (event: PointerEvent): void => {
    if (!this.pointers.delete(event.pointerId)) return;
    if (this.pointers.size > 0) {
      this.gesture = this.pointers.size > 1 ? "pinch" : "orbit";
      this.glide = { yaw: 0, pitch: 0 };
      return;
    }
    const restedBeforeRelease = event.timeStamp - this.lastMoveAt > 60;
    if (this.gesture !== "orbit" || restedBeforeRelease || this.reducedMotion.matches) {
      this.glide = { yaw: 0, pitch: 0 };
    }
    this.gesture = null;
    this.surface.classList.remove("grabbing");
    this.schedule();
  };

  private dragOrbit(right: number, down: number, at: number): void {
    const elapsed = Math.max(4, Math.min(100, at - this.lastMoveAt));
    this.lastMoveAt = at;
    const blend = Math.min(1, elapsed / 40);
    this.glide.yaw += (-right / elapsed - this.glide.yaw) * blend;
    this.glide.pitch += (down / elapsed - this.glide.pitch) * blend;
    this.change((camera) => orbit(camera, -right, down));
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
    this.change((camera) => this.zoom(camera, Math.exp(pixels * rate)));
  };

  private readonly keyDown = (event: KeyboardEvent): void => {
    const elsewhere = event.target !== this.surface && event.target !== document.body;
    if (elsewhere || event.ctrlKey || event.metaKey || event.altKey) return;
    this.shiftHeld = event.shiftKey;
    if (event.key === "f" || event.key === "F") {
      this.host.fit();
    } else if (navigationKeys.has(event.key)) {
      if (!this.heldKeys.has(event.key)) {
        this.heldKeys.add(event.key);
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
      return away ? this.zoom(moved, Math.exp(away * keyDollyPerMs * elapsedMs)) : moved;
    });
  }

  private zoom(camera: Camera, factor: number): Camera {
    const size = this.host.sceneSize();
    return dolly(camera, factor, 0.02 * size, 20 * size);
  }

  private change(move: (camera: Camera) => Camera): void {
    const camera = this.next ?? this.host.camera();
    if (!camera) return;
    this.next = move(camera);
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
    const gliding = this.pointers.size === 0 && this.continueGlide(elapsed);
    if (this.next) {
      const camera = this.next;
      this.next = null;
      this.host.moved(camera);
    }
    if (gliding || this.heldKeys.size > 0) {
      cancelAnimationFrame(this.frameRequest);
      this.lastFrameAt = now;
      this.frameRequest = requestAnimationFrame(this.frame);
    }
  };

  private continueGlide(elapsedMs: number): boolean {
    const { yaw, pitch } = this.glide;
    if (Math.hypot(yaw, pitch) < slowestGlide) {
      this.glide = { yaw: 0, pitch: 0 };
      return false;
    }
    this.change((camera) => orbit(camera, yaw * elapsedMs, pitch * elapsedMs));
    const decay = Math.exp(-elapsedMs / inertiaMs);
    this.glide = { yaw: yaw * decay, pitch: pitch * decay };
    return true;
  }
}
