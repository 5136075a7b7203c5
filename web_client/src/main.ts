// Puts the page together.

import { mountStatus } from "./overlay/status.ts";
import { Toasts } from "./overlay/toasts.ts";
import { createHelp } from "./overlay/help.ts";
import { mountTooltips } from "./overlay/tooltip.ts";
import { mountPanel } from "./panel/panel.ts";
import { Navigation } from "./view/navigation.ts";
import { pictureSize, watchSize } from "./view/viewport.ts";
import { Viewer } from "./viewer.ts";

const resizeQuietMs = 150;

/** What a processor that renders in software is asked for at most: about 1024 x 576. */
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
  const navigation = new Navigation(canvas, {
    camera: () => (viewer.hello ? viewer.camera.value : null),
    sceneSize: () => viewer.sceneSize(),
    moved: (camera) => viewer.moveCamera(camera),
    fit: () => void viewer.fitCamera(),
  });
  viewer.cameraBusy = () => navigation.active;

  const help = createHelp(find<HTMLDialogElement>("help"));
  const panel = mountPanel(find("panel"), viewer, {
    help: help.open,
    fullscreen: document.fullscreenEnabled ? toggleFullscreen : null,
  });
  mountStatus(viewer, find("pill"), find("notice"));
  mountTooltips();

  viewer.chooseSize = ({ limits, device }) => {
    const { scale, automatic } = panel.resolution.value;
    return pictureSize(canvas.clientWidth, canvas.clientHeight, devicePixelRatio * scale, {
      maxWidth: limits.max_width,
      maxHeight: limits.max_height,
      maxPixels: automatic && device.type === "cpu" ? softwarePixels : Infinity,
    });
  };
  let resizeTimer = 0;
  watchSize(canvas, () => {
    clearTimeout(resizeTimer);
    resizeTimer = window.setTimeout(() => viewer.updateSize(), resizeQuietMs);
  });
  panel.resolution.watch(() => viewer.updateSize());

  viewer.scene.watch((scene) => {
    document.title = scene ? `${scene.name} · Heliograph` : "Heliograph";
  });
  const pauseUnseen = (): void => viewer.requestStream({ paused: document.hidden });
  document.addEventListener("visibilitychange", pauseUnseen);
  pauseUnseen();
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const focused = document.activeElement;
    if (focused?.matches("input:not([type=range], [type=checkbox]), select, dialog *")) return;
    if (event.key === "?") help.open();
    else if (event.key === "h" || event.key === "H") panel.toggle();
    else if (event.key === "Enter" && focused === canvas) toggleFullscreen();
    else return;
    event.preventDefault();
  });
  viewer.connection.open();
}

main();
