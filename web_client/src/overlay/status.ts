// State of the connection: a pill in the corner, and a notice while there is no frame.

import { humanise } from "heliograph/settings_schema.ts";
import { thumbnailOf } from "../previews/thumbnails.ts";
import { type ControlState, viewerName } from "../session/control_state.ts";
import { type Loading, firstFrameStage } from "../session/scene_loading.ts";
import type { Viewer } from "../session/viewer.ts";
import type { ConnectionState } from "../stream/connection.ts";
import { element, setText } from "../widgets/element.ts";

interface Notice {
  title: string;
  detail: string;
  /** In [0, 1]; undefined shows no bar, null an indeterminate one. */
  progress?: number | null;
  /** A preview of the scene that is being loaded, if there is one. */
  poster?: string | null;
  action?: { label: string; run: () => void };
  /** Whether the last frame stays visible, dimmed, behind the notice. */
  dims: boolean;
  /** Whether the notice leaves the middle of the frame free. */
  aside?: boolean;
}

const retryRefreshMs = 250;

export function mountStatus(viewer: Viewer, pill: HTMLElement, card: HTMLElement): void {
  const view = createCard(card);
  const pillText = element("span", { class: "pill-text" });
  pill.append(element("span", { class: "dot" }), pillText);
  const update = (): void => {
    const state = viewer.connection.state.value;
    pill.dataset.state = state.kind;
    const own = viewer.own.shared.value !== null;
    setText(pillText, pillLabel(state, viewer.membership.controlState.value, own));
    view.show(noticeFor(viewer, state));
  };
  viewer.connection.state.watch(update);
  viewer.membership.controlState.watch(update);
  viewer.own.shared.watch(update);
  viewer.loading.current.watch(update);
  viewer.restoring.watch(update);
  viewer.scenes.watch(update);
  viewer.scene.watch(update);
  let hadFrame = false;
  viewer.frame.watch((frame) => {
    if ((frame !== null) === hadFrame) return;
    hadFrame = frame !== null;
    update();
  });
  setInterval(() => {
    if ("retryAt" in viewer.connection.state.value) update();
  }, retryRefreshMs);
}

function pillLabel(state: ConnectionState, controlState: ControlState, own: boolean): string {
  switch (state.kind) {
    case "connecting":
      return "Connecting";
    case "live":
      return own ? "Live, your own session" : liveLabel(controlState);
    case "lost":
      return "Reconnecting";
    case "mjpeg_fallback":
      return "View only (no WebSocket)";
    case "full":
      return "Server full";
    case "wrong_version":
      return "Page out of date";
    case "forbidden":
      return "No access";
  }
}

function liveLabel(controlState: ControlState): string {
  switch (controlState.kind) {
    case "may_change":
      return "Live";
    case "read_only":
      return "Live, view only";
    case "looks_around":
      return "Live, looking around";
    case "other":
      return `Live, ${controlState.name} is in control`;
    case "unclaimed":
      return "Live, no viewer is in control";
  }
}

function noticeFor(viewer: Viewer, state: ConnectionState): Notice | null {
  const retry = { label: "Retry now", run: () => viewer.connection.retryNow() };
  switch (state.kind) {
    case "connecting":
      return { title: "Connecting", detail: "Waiting for the server", progress: null, dims: true };
    case "lost":
      return {
        title: "Connection lost",
        detail: `The server does not answer. ${countdown(state.retryAt)}`,
        action: retry,
        dims: true,
      };
    case "mjpeg_fallback":
      return null;
    case "full":
      return {
        title: "The server is full",
        detail: `It accepts no more viewers. ${countdown(state.retryAt)}`,
        action: retry,
        dims: true,
      };
    case "wrong_version":
      return {
        title: "Page out of date",
        detail: `The server uses ${state.detail || "another protocol"} now. Reload the page.`,
        action: { label: "Reload", run: () => location.reload() },
        dims: true,
      };
    case "forbidden":
      return {
        title: "No access",
        detail: state.detail ? asSentence(state.detail) : "The server denies access to this page.",
        action: { label: "Reload", run: () => location.reload() },
        dims: true,
      };
    case "live":
      return liveNotice(viewer);
  }
}

function liveNotice(viewer: Viewer): Notice | null {
  const loading = viewer.loading.current.value;
  if (loading) return loadingNotice(viewer, loading);
  if (viewer.restoring.value) {
    const title = viewer.own.shared.value === null ? "Restoring the view" : "Opening the view";
    const detail = "Loading scene, settings and camera";
    return { title, detail, progress: null, dims: true };
  }
  if (!viewer.scene.value) {
    return viewer.scenes.value.scenes.length > 0
      ? { title: "No scene loaded", detail: "Choose a scene in the panel.", dims: false }
      : {
          title: "No scenes found",
          detail: viewer.hello?.limits.max_upload_bytes
            ? "Drop a .glb file here, or choose one with Upload in the panel."
            : "Put .glb or .gltf files into the scene folder of the server.",
          action: { label: "Refresh", run: () => void viewer.shown.readList() },
          dims: false,
        };
  }
  if (!viewer.frame.value) {
    const detail = "Waiting for the first frame";
    return { title: "Rendering", detail, progress: null, dims: false };
  }
  return null;
}

/** The old scene stays visible, dimmed, up to the first frame of the new one, textured or not. */
function loadingNotice(viewer: Viewer, loading: Loading): Notice {
  const { kind, name, stage, fraction, by, firstView = false } = loading;
  const isScene = kind === "scene" && stage !== firstFrameStage;
  const viewers = viewer.membership.session.value?.viewers ?? [];
  const author = viewers.findIndex((one) => one.viewer === by && !one.you);
  const other = viewers[author];
  const done = firstView ? ` ${Math.round(fraction * 100)} %` : "";
  const detail =
    stage === firstFrameStage ? "Rendering the first frame" : `${humanise(stage)}${done}`;
  return {
    title: `Loading ${name}…`,
    poster: kind === "scene" && !firstView ? thumbnailOf(name) : null,
    action:
      isScene && viewer.mayChange && viewer.capabilities.has("scene.cancel")
        ? { label: "Cancel", run: () => void viewer.loading.cancel() }
        : undefined,
    detail: other ? `${viewerName(other, author)} loads it. ${detail}` : detail,
    progress: fraction > 0 && stage !== firstFrameStage ? fraction : null,
    dims: !firstView,
    aside: firstView,
  };
}

function countdown(retryAt: number): string {
  const seconds = Math.ceil((retryAt - Date.now()) / 1000);
  return seconds > 0 ? `Retrying in ${seconds} s.` : "Retrying now.";
}

function createCard(card: HTMLElement): { show(notice: Notice | null): void } {
  const title = element("h1");
  const detail = element("p");
  const bar = element("div", { class: "bar" });
  const progress = element("div", { class: "progress", role: "progressbar" }, bar);
  const action = element("button", { type: "button", class: "button" });
  let run: () => void = () => {};
  action.addEventListener("click", () => run());
  const poster = element("img", { class: "poster", alt: "" });
  card.append(poster, element("div", { class: "card" }, title, detail, progress, action));
  return {
    show(notice) {
      card.hidden = notice === null;
      if (!notice) return;
      card.classList.toggle("dims", notice.dims);
      card.classList.toggle("aside", notice.aside ?? false);
      setText(title, notice.title);
      poster.hidden = !notice.poster;
      if (notice.poster && poster.src !== notice.poster) poster.src = notice.poster;
      setText(detail, notice.detail);
      progress.hidden = notice.progress === undefined;
      progress.classList.toggle("indeterminate", notice.progress === null);
      bar.style.width = typeof notice.progress === "number" ? `${notice.progress * 100}%` : "";
      progress.setAttribute("aria-label", notice.title);
      if (typeof notice.progress === "number") {
        progress.setAttribute("aria-valuenow", String(Math.round(notice.progress * 100)));
      } else {
        progress.removeAttribute("aria-valuenow");
      }
      action.hidden = !notice.action;
      setText(action, notice.action?.label ?? "");
      run = notice.action?.run ?? (() => {});
    },
  };
}

/** A reason given by the server, with a capital letter and a full stop. */
function asSentence(reason: string): string {
  const capitalised = reason.charAt(0).toUpperCase() + reason.slice(1);
  return /[.!?]$/.test(capitalised) ? capitalised : `${capitalised}.`;
}
