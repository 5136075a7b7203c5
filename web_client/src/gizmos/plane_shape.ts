// How a section plane, which has no end, is drawn: as the rectangle of it that the scene covers.

import type { Vector3 } from "heliograph/json.ts";
import type { SceneInfo, SectionPlane } from "heliograph/messages.ts";
import { add, cross, dot, normalize, scale, subtract } from "../common/vector.ts";

/** How far the rectangle reaches beyond the scene, as a part of its half sides. */
const margin = 0.06;
/** Least half side of the rectangle, as a part of the larger one. */
const leastSide = 0.02;

type Bounds = SceneInfo["bounds"];

export function centreOf({ min, max }: Bounds): Vector3 {
  return scale(add(min, max), 0.5);
}

/** The point of the plane, whose normal has unit length, that is nearest to `point`. */
export function nearestOn({ normal, offset }: SectionPlane, point: Vector3): Vector3 {
  return add(point, scale(normal, offset - dot(normal, point)));
}

/** Corners of the rectangle, one after the other around it. */
export function planeQuad(plane: SectionPlane, bounds: Bounds): Vector3[] {
  const centre = nearestOn(plane, centreOf(bounds));
  const [across, along] = tangents(plane.normal);
  const half = scale(subtract(bounds.max, bounds.min), 0.5);
  const extent = (axis: Vector3): number =>
    half.reduce((sum, side, i) => sum + Math.abs(side * (axis[i] as number)), 0);
  const [width, height] = [extent(across), extent(along)];
  const least = leastSide * Math.max(width, height) || 1;
  const side = (axis: Vector3, size: number): Vector3 =>
    scale(axis, (1 + margin) * Math.max(size, least));
  const [right, up] = [side(across, width), side(along, height)];
  return [
    subtract(subtract(centre, right), up),
    add(subtract(centre, up), right),
    add(add(centre, right), up),
    subtract(add(centre, up), right),
  ];
}

/** Two unit vectors in the plane: along world axes where it is. */
function tangents(normal: Vector3): [Vector3, Vector3] {
  const upright: Vector3 = Math.abs(normal[1]) < 0.9 ? [0, 1, 0] : [0, 0, 1];
  const across = normalize(cross(upright, normal));
  return [across, cross(normal, across)];
}
