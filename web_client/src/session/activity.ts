// Changes of the session by other viewers, in words: "Ada changed the light sun".

import type { Notifications, SessionInfo } from "heliograph/messages.ts";
import type { ControlGroup } from "heliograph/settings_schema.ts";
import { viewerName } from "./control_state.ts";
import { describePatch } from "./history/settings_steps.ts";

export interface Activity {
  /** The viewer's id. */
  viewer: string;
  name: string;
  /** What it did, as in "loaded atrium". */
  deed: string;
  /** Whether it shows only while it happens, as camera movements do. */
  transient: boolean;
}

type Change = Partial<
  Notifications["settings.changed"] &
    Notifications["lights.changed"] &
    Notifications["materials.changed"] &
    Notifications["environment.changed"] &
    Notifications["scene.changed"]
>;

/** What a notification tells about another viewer; null where none is behind it. */
export function activityOf(
  method: string,
  params: unknown,
  session: SessionInfo | null,
  schema: ControlGroup,
): Activity | null {
  const { by } = params as { by?: string };
  const deed = deedOf(method, params as Change, schema);
  const index = session?.viewers.findIndex(({ viewer }) => viewer === by) ?? -1;
  const viewer = session?.viewers[index];
  if (!by || !deed || !viewer || viewer.you) return null;
  const transient = method === "camera.changed";
  return { viewer: by, name: viewerName(viewer, index), deed, transient };
}

function deedOf(method: string, change: Change, schema: ControlGroup): string | null {
  switch (method) {
    case "settings.changed":
      return `changed ${describePatch(schema, change.patch ?? {})}`;
    case "lights.changed":
      return `changed the light ${change.light?.name}`;
    case "materials.changed":
      return `changed the material ${change.material?.name}`;
    case "textures.changed":
      return "changed a texture";
    case "environment.changed":
      return change.current
        ? `chose the environment ${change.current}`
        : "chose the environment of the scene file";
    case "scene.changed":
      return `loaded ${change.scene?.name}`;
    case "bookmarks.changed":
      return "changed the bookmarks";
    case "section.changed":
      return "changed the section planes";
    case "measurements.changed":
      return "changed the measurements";
    case "annotations.changed":
      return "changed the annotations";
    case "camera.changed":
      return "moved the camera";
    default:
      return null;
  }
}
