// Where points of the world are in the view, as a camera shows them.

import type { Vector3 } from "heliograph/json.ts";
import { type CameraPose, basis } from "../common/camera_pose.ts";
import { dot, normalize, subtract } from "../common/vector.ts";

/** CSS pixels from the view's top left corner. */
export interface ViewPoint {
  x: number;
  y: number;
}

/** What is nearer to the eye than this part of the distance to the target is cut off. */
const nearestShare = 1e-4;

export class Projection {
  private readonly axes: [Vector3, Vector3, Vector3];
  private readonly eye: Vector3;
  private readonly nearest: number;
  private readonly scale: number;
  private readonly centre: ViewPoint;

  /**
   * Of a view that shows the middle of a frame of `frameAspect`, width by height, scaled so that it
   * covers `width` by `height` CSS pixels.
   */
  constructor(camera: CameraPose, frameAspect: number, width: number, height: number) {
    const { rightward, upward, distance } = basis(camera);
    this.axes = [rightward, upward, normalize(subtract(camera.target, camera.eye))];
    this.eye = camera.eye;
    this.nearest = nearestShare * distance;
    const frameHeight = Math.max(height, width / frameAspect);
    this.scale = frameHeight / 2 / Math.tan((camera.vertical_fov * Math.PI) / 360);
    this.centre = { x: width / 2, y: height / 2 };
  }

  /** Null behind the eye. */
  point(position: Vector3): ViewPoint | null {
    const seen = this.seen(position);
    return seen[2] > this.nearest ? this.place(seen) : null;
  }

  /** The part of a line that lies before the eye; null where none does. */
  line(from: Vector3, to: Vector3): [ViewPoint, ViewPoint] | null {
    const [a, b] = [this.seen(from), this.seen(to)];
    if (Math.max(a[2], b[2]) <= this.nearest) return null;
    const cut = (point: Vector3, other: Vector3): Vector3 => {
      if (point[2] > this.nearest) return point;
      const t = (this.nearest - other[2]) / (point[2] - other[2]);
      const mix = (axis: 0 | 1): number => other[axis] + t * (point[axis] - other[axis]);
      return [mix(0), mix(1), this.nearest];
    };
    return [this.place(cut(a, b)), this.place(cut(b, a))];
  }

  /** Unit vectors of the world across the view, and away from the eye. */
  get directions(): { rightward: Vector3; upward: Vector3; forward: Vector3 } {
    const [rightward, upward, forward] = this.axes;
    return { rightward, upward, forward };
  }

  /** CSS pixels of a metre across the view at a point; 0 behind the eye. */
  pixelsPerMetre(position: Vector3): number {
    const depth = this.seen(position)[2];
    return depth > this.nearest ? this.scale / depth : 0;
  }

  /** How a point moves over the view along a unit vector, CSS pixels per metre; null behind the eye. */
  motion(position: Vector3, along: Vector3): ViewPoint | null {
    const [right, up, forward] = this.seen(position);
    if (forward <= this.nearest) return null;
    const [rightRate, upRate, forwardRate] = this.axes.map((axis) => dot(axis, along)) as Vector3;
    const scale = this.scale / forward;
    return {
      x: scale * (rightRate - (right * forwardRate) / forward),
      y: -scale * (upRate - (up * forwardRate) / forward),
    };
  }

  /** In the camera's axes: right, up, forward. */
  private seen(position: Vector3): Vector3 {
    const offset = subtract(position, this.eye);
    return this.axes.map((axis) => dot(axis, offset)) as Vector3;
  }

  private place([right, up, forward]: Vector3): ViewPoint {
    const scale = this.scale / forward;
    return { x: this.centre.x + right * scale, y: this.centre.y - up * scale };
  }
}
