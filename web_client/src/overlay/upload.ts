// A scene file dropped on the page goes to the server, where that is allowed, and is shown.

import { Toasts } from "./toasts.ts";
import { element } from "../panel/element.ts";
import type { Viewer } from "../viewer.ts";

const notOffered = [404, 405];

export function mountUpload(viewer: Viewer, root: HTMLElement, toasts: Toasts): void {
  const veil = element(
    "div",
    { class: "drop-veil", hidden: true },
    element("p", {}, "Drop a .glb file to show it"),
  );
  root.append(veil);
  const carriesFile = (event: DragEvent): boolean =>
    event.dataTransfer?.types.includes("Files") ?? false;
  addEventListener("dragenter", (event) => {
    if (carriesFile(event) && viewer.hello && viewer.inControl) veil.hidden = false;
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
    if (file) void bring(viewer, file, toasts);
  });
}

async function bring(viewer: Viewer, file: File, toasts: Toasts): Promise<void> {
  if (!file.name.toLowerCase().endsWith(".glb")) {
    toasts.show("Only .glb files can be brought along: they hold everything in one.");
    return;
  }
  const name = sceneName(file.name);
  try {
    await upload(name, file, (fraction) => {
      viewer.loading.set({ name, stage: "sending the file", fraction });
    });
    await viewer.refreshScenes();
    await viewer.loadScene(name);
  } catch (error) {
    viewer.loading.set(null);
    toasts.show((error as Error).message);
  }
}

/** "My model (1).glb" -> "My_model_1": what servers take for a name. */
export function sceneName(file: string): string {
  const stem = file.replace(/\.[^.]*$/, "");
  return stem.replace(/[^\w.-]+/g, "_").replace(/^[_.]+|[_.]+$/g, "") || "scene";
}

/** Rejects with a sentence for the person. XMLHttpRequest, because fetch tells no progress. */
function upload(name: string, file: File, progress: (fraction: number) => void): Promise<void> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("PUT", new URL(`api/v1/scenes/${name}`, document.baseURI));
    request.upload.onprogress = ({ loaded, total }) => progress(total > 0 ? loaded / total : 0);
    request.onerror = () => reject(new Error("The file could not be sent"));
    request.onload = () => {
      if (request.status === 201) resolve();
      else reject(new Error(refusal(request)));
    };
    progress(0);
    request.send(file);
  });
}

function refusal({ status, responseText }: XMLHttpRequest): string {
  if (notOffered.includes(status)) return "This server takes no files from viewers";
  try {
    const { error, message } = JSON.parse(responseText) as {
      error?: { message?: string };
      message?: string;
    };
    return error?.message ?? message ?? `The server refused the file (${status})`;
  } catch {
    return responseText.trim() || `The server refused the file (${status})`;
  }
}
