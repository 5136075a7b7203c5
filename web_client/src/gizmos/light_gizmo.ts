// The handles of a light: three axes and its centre move it, another one turns it.

import type { LightInfo, SceneInfo } from "heliograph/messages.ts";
import { normalize } from "../common/vector.ts";
import type { SceneParts } from "../session/scene_parts.ts";
import { type Edit, type Gizmo, moveHandles, turnHandle } from "./gizmo.ts";
import { centreOf } from "./plane_shape.ts";
import type { Deed, Pose } from "./pose.ts";

type Lights = Pick<SceneParts, "previewLight" | "recordLight" | "restoreLight">;

/** A directional light, which has no position, is turned at the scene's centre. */
export function lightGizmo(light: LightInfo, bounds: SceneInfo["bounds"], lights: Lights): Gizmo {
  const { name, position } = light;
  const direction = light.direction ? normalize(light.direction) : null;
  const handles = position ? moveHandles(name, position, bounds) : [];
  if (direction) handles.push(turnHandle(name, direction));
  return {
    key: `light ${light.type} ${name}`,
    pose: { anchor: position ?? centreOf(bounds), direction },
    handles,
    outline: [],
    begin: (kind) => lightEdit(light, kind, lights),
  };
}

function lightEdit(before: LightInfo, kind: Deed["kind"], lights: Lights): Edit {
  const { name } = before;
  const member = kind === "turn" ? "direction" : "position";
  let change: Partial<LightInfo> | null = null;
  return {
    show({ anchor, direction }: Pose) {
      change = kind === "turn" ? { direction: direction ?? undefined } : { position: anchor };
      lights.previewLight(name, change);
    },
    keep(key) {
      const label = `${kind === "turn" ? "turn" : "move"} light ${name}`;
      if (change) lights.recordLight(before, change, label, `${label} ${key}`);
    },
    revert() {
      if (change) lights.restoreLight(before, [member]);
    },
  };
}
