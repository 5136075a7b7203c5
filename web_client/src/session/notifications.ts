// What the server's notifications change on the page.

import type { FrameStats, Notifications, SessionInfo } from "heliograph/messages.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import type { Signal } from "../common/signal.ts";
import type { UploadLists } from "../common/uploads.ts";
import type { Bookmarks } from "./bookmarks.ts";
import type { Company } from "./company/company.ts";
import type { Marks } from "./marks/marks.ts";
import type { NodeStore } from "./node_store.ts";
import type { SceneLoading } from "./scene_loading.ts";
import type { SceneParts } from "./scene_parts.ts";
import type { Textures } from "./edits/textures.ts";
import type { SectionStore } from "./section_store.ts";
import type { SettingsStore } from "./settings_store.ts";
import type { ShownScene } from "./shown_scene.ts";
import type { UndoHistory } from "./history/undo_history.ts";
import type { ViewRestore } from "./view_restore.ts";

interface Targets {
  settings: SettingsStore;
  parts: SceneParts;
  textures: Textures;
  nodes: NodeStore;
  section: SectionStore;
  shown: ShownScene;
  loading: SceneLoading;
  history: UndoHistory;
  bookmarks: Bookmarks;
  marks: Marks;
  uploads: UploadLists;
  company: Company;
  stats: Signal<FrameStats | null>;
  viewRestore: ViewRestore;
  takeCamera(camera: CameraPose): void;
  setSession(session: SessionInfo): void;
  /** The viewer that this page followed has gone elsewhere. */
  leftBehind(): void;
}

export function receiveNotification(targets: Targets, method: string, params: unknown): void {
  switch (method) {
    case "settings.changed":
      targets.settings.receive(params as Notifications["settings.changed"]);
      break;
    case "camera.changed":
      targets.takeCamera((params as Notifications["camera.changed"]).camera);
      break;
    case "animation.changed":
      // The state that is being restored has a clip of its own.
      if (targets.viewRestore.pending) break;
      targets.shown.takeAnimation((params as Notifications["animation.changed"]).animation);
      break;
    case "scene.changed":
      targets.history.dropScene();
      void targets.shown.change((params as Notifications["scene.changed"]).scene);
      break;
    case "bookmarks.changed":
      targets.bookmarks.take((params as Notifications["bookmarks.changed"]).list);
      break;
    case "measurements.changed":
    case "annotations.changed":
      targets.marks.notified(method, params);
      break;
    case "session.changed":
      targets.setSession(params as Notifications["session.changed"]);
      break;
    case "pointer.changed":
      targets.company.pointers.take(params as Notifications["pointer.changed"]);
      break;
    case "viewer.unfollowed":
      targets.leftBehind();
      break;
    case "lights.changed":
    case "materials.changed":
    case "environment.changed":
      targets.parts.notified(method, params);
      break;
    case "edits.changed":
      targets.parts.notified(method, params);
      targets.textures.notified(params as Notifications["edits.changed"]);
      break;
    case "textures.changed":
      targets.textures.notified(params as Notifications["textures.changed"]);
      break;
    case "uploads.changed":
      targets.uploads.notified(params as Notifications["uploads.changed"]);
      break;
    case "nodes.changed":
    case "selection.changed":
      targets.nodes.notified(method, params);
      break;
    case "section.changed":
      targets.section.take(params as Notifications["section.changed"]);
      break;
    case "scene.progress":
      targets.loading.progressed(params as Notifications["scene.progress"]);
      break;
    case "stats.frame":
      targets.stats.set(params as Notifications["stats.frame"]);
      break;
  }
}
