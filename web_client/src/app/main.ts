// Entry point: creates the page's parts and connects them.

import { Comparison } from "../compare/comparison.ts";
import { fileStem, outputActions } from "../output/output_actions.ts";
import { createSaveDialog } from "../output/save_dialog.ts";
import { createEmbedDialog } from "../output/embed_dialog.ts";
import { createRenderDialog } from "../output/render_dialog.ts";
import { reportToEmbeddingPage } from "../embed/embedding_page.ts";
import { mountGizmos } from "../gizmos/gizmos.ts";
import { mountFirstHint } from "../overlay/first_hint.ts";
import { mountFollowing } from "../overlay/following.ts";
import { createHelp } from "../overlay/help.ts";
import { mountMarks } from "../overlay/marks.ts";
import { mountMjpegFallback } from "../overlay/mjpeg_fallback.ts";
import { mountParticipants } from "../overlay/participants.ts";
import { mountPointers } from "../overlay/pointers.ts";
import { mountRefining } from "../overlay/refining.ts";
import { mountStatus } from "../overlay/status.ts";
import { Toasts } from "../overlay/toasts.ts";
import { mountTransport } from "../overlay/transport.ts";
import { mountUpload, uploadFile, uploadImage } from "../overlay/upload.ts";
import { viewFrom } from "../panel/scene/view_buttons.ts";
import { mountPanel } from "../panel/panel.ts";
import { bookmarkPath, createPathOptions } from "../panel/scene/path_fields.ts";
import { viewIn } from "../session/view_link.ts";
import { Viewer } from "../session/viewer.ts";
import { AutoRotate, type AutoRotateHost } from "../view/auto_rotate.ts";
import { type ViewSide, fitBeside, focusOn } from "../view/camera.ts";
import { createDivider } from "../view/divider.ts";
import { Navigation } from "../view/navigation.ts";
import { PathPlayer } from "../view/path_player.ts";
import { createPicker } from "../view/picker.ts";
import { PointTool } from "../view/point_tool.ts";
import { frameSize, pointInFrame, watchSize } from "../view/viewport.ts";
import { mountTooltips } from "../widgets/tooltip.ts";

const textInputs = "input:not([type=range], [type=checkbox]), textarea";
const resizeDelayMs = 150;

/** By key code, since Shift changes what digits write: a side and its opposite. */
const sideKeys: Record<string, [ViewSide, ViewSide]> = {
  Digit1: ["front", "back"],
  Digit2: ["right", "left"],
  Digit3: ["top", "bottom"],
};

/** Focusing on a point keeps this fraction of the distance to it. */
const focusDistance = 0.6;

/** Most pixels to request of a server that renders on its CPU: about 1024 x 576. */
const softwarePixels = 590_000;

function find<Type extends HTMLElement>(id: string): Type {
  const node = document.getElementById(id);
  if (!node) throw new Error(`The page lacks #${id}`);
  return node as Type;
}

function toggleFullscreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.documentElement.requestFullscreen();
}

function main(): void {
  const canvas = find<HTMLCanvasElement>("view");
  const viewer = new Viewer(document.baseURI, canvas);
  const toasts = new Toasts(find("toasts"));
  viewer.onError = (message) => toasts.show(message);
  viewer.onInfo = (message, topic) => toasts.inform(message, { topic });
  viewer.onFileError = ({ sentence, detail }) => toasts.show(sentence, { topic: "scene", detail });
  viewer.activity.watch((activity) => {
    if (!activity || activity.transient) return;
    toasts.inform(`${activity.name} ${activity.deed}`, { topic: `viewer ${activity.viewer}` });
  });
  viewer.loading.current.watch((loading) => {
    if (loading) toasts.settle("scene");
  });
  const points = new PointTool({
    canvas,
    // This picker and the next come before others, so that they take the click first.
    picker: createPicker(canvas, find("mark")),
    snap: (x, y, free) => viewer.queries.snap(x, y, free),
  });
  const focus = createPicker(canvas, find("mark"));
  mountMarks(find("marks"), viewer, points);
  mountPointers(find("pointers"), canvas, viewer);
  const navigation = new Navigation(canvas, {
    camera: () => (viewer.hello && viewer.membership.mayMove ? viewer.camera.value : null),
    sceneSize: () => viewer.shown.size,
    moved: (camera, recorded, movement) =>
      viewer.cameraMoves.moveTo(camera, recorded, movement),
    fit: () => fit(),
    surfaceAt: (x, y) => viewer.queries.surfaceAt(x, y),
    focus: (x, y) => void focusAt(x, y),
  });
  const focusAt = async (x: number, y: number): Promise<void> => {
    if (!viewer.membership.mayMove || points.task.value) return;
    const pick = await viewer.queries.pick(x, y);
    const camera = viewer.camera.value;
    if (!camera || !pick?.position || pick.distance === null) return;
    navigation.goTo(focusOn(camera, pick.position, pick.distance * focusDistance));
  };
  const fit = (): void => {
    if (viewer.membership.mayMove && !viewer.restoring.value) void viewer.cameraMoves.fit();
  };
  viewer.cameraMoves.place = (camera) => {
    const { left } = find("panel").getBoundingClientRect();
    const { clientWidth, clientHeight } = canvas;
    const covered = panel.isBeside() ? Math.max(0, 1 - left / clientWidth) : 0;
    const aspect = clientWidth / clientHeight;
    const frame = viewer.frame.value;
    const frameAspect = frame ? frame.width / frame.height : aspect;
    const cropped = aspect < 0.98 * frameAspect;
    return covered > 0 || cropped ? fitBeside(camera, frameAspect, aspect, covered) : camera;
  };
  viewer.cameraMoves.animateTo = (camera, recorded) => navigation.goTo(camera, recorded);
  viewer.cameraMoves.isBusy = () => navigation.active;

  const cameraHost: AutoRotateHost = {
    camera: () => (viewer.hello && viewer.membership.mayMove ? viewer.camera.value : null),
    moved: (camera) => viewer.cameraMoves.moveTo(camera, false),
    isBusy: () => navigation.active,
  };
  const rotation = new AutoRotate(cameraHost);
  const player = new PathPlayer(cameraHost);
  viewer.cameraMoves.stop = () => {
    navigation.stop();
    player.stop();
  };
  const path = createPathOptions();
  const divider = createDivider(find("compare"));
  mountMjpegFallback(viewer, find("mjpeg"));
  mountParticipants(viewer, find("participants"), (message) => toasts.inform(message));
  mountFollowing(viewer, find("following"));
  const inform = (message: string): void => toasts.inform(message);
  const saveDialog = createSaveDialog(find<HTMLDialogElement>("save"), viewer, {
    fileStem: () => fileStem(viewer),
    inform,
  });
  const jobsPage = (): string => viewer.connection.address.url("jobs").href;
  const renderDialog = createRenderDialog(find<HTMLDialogElement>("render"), viewer, {
    fileStem: () => fileStem(viewer),
    jobsPage,
    path: () => bookmarkPath(viewer, path),
  });
  const embedDialog = createEmbedDialog(find<HTMLDialogElement>("embed"), viewer, inform);
  const help = createHelp(find<HTMLDialogElement>("help"));
  const comparison = new Comparison(viewer, () => divider.newCanvas());
  const panel = mountPanel(find("panel"), viewer, {
    output: outputActions(viewer, {
      recordingButton: find("recording"),
      save: saveDialog.open,
      render: renderDialog.open,
      jobsPage,
      embed: embedDialog.open,
      inform,
    }),
    inspect: {
      comparison,
      divider,
      picker: createPicker(canvas, find("mark")),
      points,
    },
    camera: { rotation, player, path, focus },
    selection: createPicker(canvas, find("mark")),
    upload: (file) => void uploadFile(viewer, file, toasts),
    uploadImage: (file) => uploadImage(viewer, file, toasts),
    help: help.open,
    fullscreen: document.fullscreenEnabled ? toggleFullscreen : null,
  });
  mountGizmos(viewer, {
    root: find("gizmos"),
    lines: find("gizmo-lines"),
    view: canvas,
    covers: [find("panel"), find("transport"), find("top-left")],
    points,
    comparison: comparison.state,
  });
  mountTransport(viewer, find("transport"));
  mountStatus(viewer, find("pill"), find("notice"));
  mountRefining(viewer, find("refining"));
  mountFirstHint(viewer, canvas, find("first-hint"));
  mountTooltips();

  viewer.stream.chooseSize = ({ limits, device }) => {
    const { scale, automatic } = panel.resolution.value;
    return frameSize(canvas.clientWidth, canvas.clientHeight, devicePixelRatio * scale, {
      maxWidth: limits.max_width,
      maxHeight: limits.max_height,
      maxPixels: automatic && device.type === "cpu" ? softwarePixels : Infinity,
    });
  };
  viewer.inFrame = (x, y) => {
    const frame = viewer.frame.value;
    const view = { width: canvas.clientWidth, height: canvas.clientHeight };
    return frame ? pointInFrame(view, frame, x, y) : { x, y };
  };
  let resizeTimer = 0;
  watchSize(canvas, () => {
    clearTimeout(resizeTimer);
    resizeTimer = window.setTimeout(() => viewer.stream.updateSize(), resizeDelayMs);
  });
  panel.resolution.watch(() => viewer.stream.updateSize());

  viewer.membership.controlState.watch(() => {
    canvas.classList.toggle("locked", !viewer.membership.mayMove);
  });
  viewer.scene.watch((scene) => {
    document.title = scene ? `${scene.name} · Heliograph` : "Heliograph";
  });
  const pauseHidden = (): void => viewer.stream.request({ paused: document.hidden });
  document.addEventListener("visibilitychange", pauseHidden);
  pauseHidden();
  addEventListener("keydown", (event) => {
    const isUndo = (event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z";
    if (isUndo && viewer.mayChange && !document.activeElement?.matches(textInputs)) {
      if (event.shiftKey) viewer.redo();
      else viewer.undo();
      event.preventDefault();
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const focused = document.activeElement;
    if (focused?.matches(`${textInputs}, select, dialog *`)) return;
    if (event.key === "?") help.open();
    else if (event.key === "h" || event.key === "H") panel.toggle();
    else if (event.key === "b" || event.key === "B") viewer.addBookmark();
    else if (event.code in sideKeys) {
      const [side, opposite] = sideKeys[event.code] as [ViewSide, ViewSide];
      viewFrom(viewer, event.shiftKey ? opposite : side);
    } else if (event.key === "r" || event.key === "R") rotation.toggle();
    else if (event.key === "m" || event.key === "M") panel.toggleMeasuring();
    else if (event.key === "n" || event.key === "N") panel.toggleAnnotating();
    else if (points.task.value && event.key === "Escape") points.cancel();
    else if (event.key === "Escape" && viewer.membership.following.value) {
      if (!event.defaultPrevented) viewer.membership.stopFollowing();
    } else if (points.task.value && event.key.toLowerCase() === "p") {
      void points.place(0.5, 0.5, false);
    } else if (event.key === " " && (focused === canvas || focused === document.body)) {
      viewer.togglePlay();
    } else if (event.key === "Enter" && focused === canvas) toggleFullscreen();
    else return;
    event.preventDefault();
  });
  const openLink = (): void => {
    const linked = viewIn(location.href);
    if (linked) viewer.own.openLink(linked);
  };
  addEventListener("hashchange", openLink);
  openLink();
  reportToEmbeddingPage(viewer);
  mountUpload(viewer, document.body, toasts);
  viewer.connection.open();
}

main();
