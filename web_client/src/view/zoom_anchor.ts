// The point of a surface under the pointer, which the wheel zooms to.

import type { Vector3 } from "heliograph/json.ts";

type Pick = (x: number, y: number) => Promise<Vector3 | null>;
/** Takes what was held back of the zoom, a factor below 1, when the surface is known. */
type Resume = (factor: number, surface: Vector3 | null, at: { x: number; y: number }) => void;

/** The pointer may move by this part of the view's width or height before another point is meant. */
const tolerance = 0.01;
/** Until the server has answered the view may come closer by this factor: not through a surface. */
const leastUnknown = 0.6;

export class ZoomAnchor {
  private readonly pick: Pick;
  private readonly resume: Resume;
  private at: { x: number; y: number } | null = null;
  private point: Vector3 | null = null;
  private isKnown = false;
  private unknownFactor = 1;
  private heldFactor = 1;

  constructor(pick: Pick, resume: Resume) {
    this.pick = pick;
    this.resume = resume;
  }

  /** The surface under the pointer, in fractions of the view; null: there is none, or not yet. */
  under(x: number, y: number): Vector3 | null {
    const { at } = this;
    if (!at || Math.abs(at.x - x) > tolerance || Math.abs(at.y - y) > tolerance) this.ask(x, y);
    return this.point;
  }

  /** How much of a zoom step may be done now: all of it, unless the surface is still unknown. */
  limit(factor: number): number {
    if (this.isKnown) return factor;
    const allowed = Math.max(factor, leastUnknown / this.unknownFactor);
    this.unknownFactor *= allowed;
    this.heldFactor *= factor / allowed;
    return allowed;
  }

  /** After the camera was moved in another way. */
  forget(): void {
    this.at = null;
    this.point = null;
    this.isKnown = false;
  }

  private ask(x: number, y: number): void {
    this.forget();
    const asked = { x, y };
    this.at = asked;
    this.unknownFactor = this.heldFactor = 1;
    void this.pick(x, y).then((point) => {
      if (this.at !== asked) return;
      this.point = point;
      this.isKnown = true;
      if (this.heldFactor < 1) this.resume(this.heldFactor, point, asked);
    });
  }
}
