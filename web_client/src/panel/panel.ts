// The side panel, which becomes a bottom sheet on narrow screens.

import { preferences } from "../common/preferences.ts";
import type { Signal } from "../common/signal.ts";

import { type Viewer, bufferSetting } from "../session/viewer.ts";
import type { PointPicker } from "../view/picker.ts";
import { button, element, icon } from "../widgets/element.ts";
import { type MenuItem, createMenu } from "../widgets/menu.ts";
import { createTabs } from "../widgets/tabs.ts";
import { createControlNote } from "./control_note.ts";
import { type InspectParts, createInspectTab } from "./inspect/inspect_tab.ts";
import type { CameraTools } from "./scene/camera_fields.ts";
import { createSceneTab, appearanceGroups } from "./scene/scene_tab.ts";
import { createSettingsTab } from "./settings/settings_tab.ts";
import { type ResolutionChoice, createStreamSection } from "./timing/stream_section.ts";
import { createTimingTab } from "./timing/timing_tab.ts";
import { createUndoButtons } from "./undo_buttons.ts";

interface PanelActions {
  output: MenuItem[];
  inspect: InspectParts;
  /** Clicks that select objects. */
  selection: PointPicker;
  camera: CameraTools;
  /** Uploads a scene file and loads it. */
  upload(file: File): void;
  /** Uploads an image; its name on the server, null where it was not taken. */
  uploadImage(file: File): Promise<string | null>;
  help(): void;
  fullscreen: (() => void) | null;
}

interface Panel {
  resolution: Signal<ResolutionChoice>;
  /** Whether it covers a part of the view at the right. */
  isBeside(): boolean;
  toggle(): void;
  /** Begins or ends measuring distances. */
  toggleMeasuring(): void;
  /** Begins or ends choosing a place for an annotation. */
  toggleAnnotating(): void;
}

const narrow = matchMedia("(max-width: 640px)");

export function mountPanel(root: HTMLElement, viewer: Viewer, actions: PanelActions): Panel {
  const stream = createStreamSection(viewer);
  const inspect = createInspectTab(viewer, actions.inspect);
  const tabs = createTabs("Panel", [
    {
      id: "scene",
      label: "Scene",
      icon: "scene",
      body: createSceneTab(viewer, actions.selection, actions.camera, actions),
    },
    {
      id: "settings",
      label: "Advanced",
      icon: "sliders",
      body: createSettingsTab(viewer, [...appearanceGroups, bufferSetting], (id) =>
        tabs.select(id),
      ),
    },
    {
      id: "inspect",
      label: "Inspect",
      icon: "layers",
      body: inspect.node,
    },
    { id: "timing", label: "Timing", icon: "chart", body: createTimingTab(viewer, stream.node) },
  ]);
  viewer.membership.controlState.watch(({ kind }) => {
    // While all controls are disabled, the panel itself takes the focus, so that keys scroll it.
    if (kind === "may_change") tabs.pages.removeAttribute("tabindex");
    else tabs.pages.tabIndex = 0;
  });
  const note = createControlNote(viewer);
  const content = element("div", { class: "panel-body" }, note, tabs.list, tabs.pages);
  const fold = element(
    "button",
    { type: "button", class: "icon-button fold", "aria-controls": "panel-content" },
    icon("panel"),
  );
  const header = element(
    "header",
    {},
    element("span", { class: "brand" }, icon("sun"), element("span", {}, "Heliograph")),
    ...createUndoButtons(viewer),
    createMenu("Save and share", "share", actions.output),
    button("Help (?)", "help", actions.help),
    actions.fullscreen ? button("Fullscreen", "fullscreen", actions.fullscreen) : null,
    fold,
  );
  root.append(header, content);

  const key = (): string => (narrow.matches ? "sheet" : "panel");
  let open = false;
  let live = false;
  const enable = (): void => {
    content.inert = !open || !live;
    content.classList.toggle("idle", !live);
  };
  const updateLive = (): void => {
    live = viewer.connection.state.value.kind === "live" && !viewer.restoring.value;
    enable();
  };
  viewer.connection.state.watch(updateLive);
  viewer.restoring.watch(updateLive);
  const show = (shown: boolean): void => {
    open = shown;
    root.classList.toggle("folded", !shown);
    document.body.classList.toggle("with-panel", shown);
    enable();
    fold.setAttribute("aria-expanded", String(shown));
    const label = shown ? "Hide panel (H)" : "Show panel (H)";
    fold.setAttribute("aria-label", label);
    fold.dataset.tip = label;
  };
  const toggle = (): void => {
    show(!open);
    preferences.setFlag(key(), open);
  };
  const restore = (): void => show(preferences.flag(key(), !narrow.matches));
  fold.addEventListener("click", toggle);
  narrow.addEventListener("change", restore);
  mountSheetDrag(header, () => open, toggle);
  restore();
  const isBeside = (): boolean => open && !narrow.matches;
  const { toggleMeasuring, toggleAnnotating } = inspect;
  return { resolution: stream.resolution, isBeside, toggle, toggleMeasuring, toggleAnnotating };
}

/** On narrow screens the header is the sheet's handle: a swipe up opens it, down closes it. */
function mountSheetDrag(header: HTMLElement, isOpen: () => boolean, toggle: () => void): void {
  let startedAt: number | null = null;
  header.addEventListener("pointerdown", (event) => {
    startedAt = narrow.matches ? event.clientY : null;
  });
  header.addEventListener("pointermove", (event) => {
    if (startedAt === null) return;
    const up = startedAt - event.clientY;
    if (isOpen() ? up < -24 : up > 24) {
      startedAt = null;
      toggle();
    }
  });
  header.addEventListener("click", (event) => {
    const onButton = event.target instanceof Element && event.target.closest("button");
    if (narrow.matches && !onButton) toggle();
  });
}
