// The handles of a section plane: an arrow along its normal moves it, a handle behind turns it.

import type { Vector3 } from "heliograph/json.ts";
import type { SceneInfo, SectionPlane } from "heliograph/messages.ts";
import { dot } from "../common/vector.ts";
import { type SectionStore, planeRange } from "../session/section_store.ts";
import { type Edit, type Gizmo, metres, turnHandle } from "./gizmo.ts";
import { centreOf, nearestOn, planeQuad } from "./plane_shape.ts";
import type { Deed, Pose } from "./pose.ts";

type Planes = Pick<SectionStore, "planes" | "preview" | "record">;

/**
 * Makes the gizmos of planes. A plane that was turned keeps its point: it is turned about the place
 * where its handles stand, which stay there.
 */
export class PlaneGizmos {
  private readonly store: Planes;
  private pivot: { key: string; point: Vector3 } | null = null;

  constructor(store: Planes) {
    this.store = store;
  }

  /** Null without a plane of this index. */
  of(index: number, scene: Pick<SceneInfo, "name" | "bounds">): Gizmo | null {
    const plane = this.store.planes.value[index];
    if (!plane) return null;
    const { normal, offset } = plane;
    const key = `${scene.name} ${index}`;
    const middle = this.pivot?.key === key ? this.pivot.point : centreOf(scene.bounds);
    const { least, most } = planeRange(normal, scene);
    const name = `plane ${index + 1}`;
    return {
      key: `plane ${index}`,
      pose: { anchor: nearestOn(plane, middle), direction: normal },
      handles: [
        {
          id: "normal",
          label: `Move ${name}`,
          deed: { kind: "along", tip: normal },
          value: { now: offset, least, most, text: metres(offset) },
        },
        turnHandle(name, normal, true),
      ],
      outline: planeQuad(plane, scene.bounds),
      begin: (kind) =>
        this.edit(index, kind, (pose) => {
          if (kind === "turn") this.pivot = { key, point: pose.anchor };
          return kind === "turn" ? turnedPlane(pose, normal) : movedPlane(pose, normal, scene);
        }),
    };
  }

  private edit(
    index: number,
    kind: Deed["kind"],
    changed: (pose: Pose) => Partial<SectionPlane>,
  ): Edit {
    const { store } = this;
    const before = store.planes.value;
    let shown = false;
    return {
      show(pose) {
        shown = true;
        const change = changed(pose);
        store.preview(before.map((plane, i) => (i === index ? { ...plane, ...change } : plane)));
      },
      keep(key) {
        const label = `${kind === "turn" ? "turn" : "move"} section plane ${index + 1}`;
        if (shown) store.record(before, label, `${label} ${key}`);
      },
      revert() {
        if (shown) store.preview(before);
      },
    };
  }
}

/** Within the scene, as the panel's slider. */
function movedPlane(
  { anchor }: Pose,
  normal: Vector3,
  scene: Pick<SceneInfo, "bounds">,
): Partial<SectionPlane> {
  const { least, most } = planeRange(normal, scene);
  return { offset: Math.max(least, Math.min(most, dot(normal, anchor))) };
}

function turnedPlane({ anchor, direction }: Pose, before: Vector3): Partial<SectionPlane> {
  const normal = direction ?? before;
  return { normal, offset: dot(normal, anchor) };
}
