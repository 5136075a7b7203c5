// A scene file dropped on the page or chosen goes to the server, where that is allowed, and is shown.

import { element, setText } from "../widgets/element.ts";
import { explained } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";
import type { Toasts } from "./toasts.ts";

const off = "This server takes no files from viewers";
const megabyte = 1024 * 1024;

export function mountUpload(viewer: Viewer, root: HTMLElement, toasts: Toasts): void {
  const words = element("p");
  const veil = element("div", { class: "drop-veil", hidden: true }, words);
  root.append(veil);
  const carriesFile = (event: DragEvent): boolean =>
    event.dataTransfer?.types.includes("Files") ?? false;
  addEventListener("dragenter", (event) => {
    if (!carriesFile(event) || !viewer.hello) return;
    setText(words, refusalNow(viewer) ?? "Drop a .glb file to show it");
    veil.hidden = false;
  });
  addEventListener("dragover", (event) => {
    if (carriesFile(event)) event.preventDefault();
  });
  addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) veil.hidden = true;
  });
  addEventListener("drop", (event) => {
    if (!carriesFile(event)) return;
    event.preventDefault();
    veil.hidden = true;
    const file = event.dataTransfer?.files[0];
    if (file) void bringScene(viewer, file, toasts);
  });
}

/** Sends a scene file to the server and shows it; says in one sentence why not. */
export async function bringScene(viewer: Viewer, file: File, toasts: Toasts): Promise<void> {
  const refused = refusalNow(viewer) ?? refusalOf(viewer, file);
  if (refused) {
    toasts.show(refused);
    return;
  }
  const name = sceneName(file.name);
  try {
    const address = viewer.connection.place.address(`api/v1/scenes/${name}`);
    await upload(address, name, file, (fraction) => {
      viewer.loading.set({ name, stage: "sending the file", fraction });
    });
    await viewer.refreshScenes();
    await viewer.loadScene(name);
  } catch (error) {
    viewer.loading.set(null);
    toasts.show((error as Error).message);
  }
}

/** Why no file at all can be brought at the moment; null if it can. */
function refusalNow(viewer: Viewer): string | null {
  const { hello } = viewer;
  if (!hello) return "There is no connection to the server";
  if (!viewer.mayChange) return explained(viewer.controlState.value);
  return hello.limits.max_upload_bytes === 0 ? off : null;
}

/** Why this file cannot be brought, as far as one can tell without sending it. */
function refusalOf(viewer: Viewer, file: File): string | null {
  if (!file.name.toLowerCase().endsWith(".glb")) {
    return "Only .glb files can be brought along: they hold everything in one";
  }
  const most = viewer.hello?.limits.max_upload_bytes ?? Infinity;
  if (file.size > most) {
    return `${file.name} has ${spoken(file.size)}; the server takes up to ${spoken(most)}`;
  }
  return file.size === 0 ? `${file.name} is empty` : null;
}

function spoken(bytes: number): string {
  const [size, unit] = bytes < megabyte ? [bytes / 1024, "kB"] : [bytes / megabyte, "MB"];
  return `${size.toFixed(size < 10 ? 1 : 0)} ${unit}`;
}

/** "My model (1).glb" -> "My_model_1": what servers take for a name. */
export function sceneName(file: string): string {
  const stem = file.replace(/\.[^.]*$/, "");
  const name = stem.replace(/[^A-Za-z0-9-]+/g, "_").replace(/^[_-]+|[_-]+$/g, "");
  return name.slice(0, 64) || "scene";
}

/** Rejects with a sentence for the person. XMLHttpRequest, because fetch tells no progress. */
function upload(
  address: URL,
  name: string,
  file: File,
  progress: (fraction: number) => void,
): Promise<void> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("PUT", address);
    request.upload.onprogress = ({ loaded, total }) => progress(total > 0 ? loaded / total : 0);
    request.onerror = () => reject(new Error("The file could not be sent"));
    request.onload = () => {
      if (request.status === 201) resolve();
      else reject(new Error(refusalSentence(name, request.status, request.responseText.trim())));
    };
    progress(0);
    request.send(file);
  });
}

function refusalSentence(name: string, status: number, text: string): string {
  switch (status) {
    case 400:
      return `The server cannot read this file: ${text}`;
    case 404:
    case 405:
      return off;
    case 409:
      return `The server has a scene called ${name} of its own: give the file another name`;
    case 413:
      return "The file is larger than the server takes";
    default:
      return text || `The server refused the file (${status})`;
  }
}
