// Uploads a scene or an environment that was dropped on the page or chosen, and shows it. Annotations
// that are dropped are added to the scene.

import { type FileError, describeFileError } from "../session/file_errors.ts";
import { describeControl } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";
import { element, setText } from "../widgets/element.ts";
import { importAnnotations } from "./annotation_import.ts";
import type { Toasts } from "./toasts.ts";

const uploadsDisabled = "This server does not accept uploads.";
const uploadText = "Drop a scene (.glb) or an environment (.hdr, .exr) to show it";
const importText = "Drop annotations (.json) to add them";
const megabyte = 1024 * 1024;

export function mountUpload(viewer: Viewer, root: HTMLElement, toasts: Toasts): void {
  const text = element("p");
  const veil = element("div", { class: "drop-veil", hidden: true }, text);
  root.append(veil);
  const carriesFile = (event: DragEvent): boolean =>
    event.dataTransfer?.types.includes("Files") ?? false;
  addEventListener("dragenter", (event) => {
    if (!carriesFile(event) || !viewer.hello) return;
    setText(text, isJson(event) ? importText : (uploadError(viewer) ?? uploadText));
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
    veil.hidden = true;
    if (event.defaultPrevented) return; // taken by what it was dropped on
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    if (/\.json$/i.test(file.name)) void importAnnotations(viewer, file);
    else void uploadFile(viewer, file, toasts);
  });
}

/** Whether the browser tells so: of a file that is still dragged it does not know the name. */
function isJson({ dataTransfer }: DragEvent): boolean {
  return [...(dataTransfer?.items ?? [])].some(({ type }) => type === "application/json");
}

/** Uploads a file and shows it; tells why if it cannot. */
export async function uploadFile(viewer: Viewer, file: File, toasts: Toasts): Promise<void> {
  const error = uploadError(viewer) ?? fileError(viewer, file);
  if (error) {
    toasts.show(error);
    return;
  }
  const name = nameOf(file.name);
  const kind = kindOf(file.name);
  const by = viewer.hello?.viewer ?? "";
  try {
    const url = viewer.connection.address.url(`api/v1/${kind}s/${name}`);
    await upload(url, file, (fraction) => {
      viewer.loading.start({ kind, name, stage: "uploading", fraction, by });
    });
    if (kind === "environment") {
      await viewer.parts.showUploadedEnvironment(name);
    } else {
      await viewer.shown.readList();
      await viewer.loading.load(name);
    }
  } catch (error) {
    viewer.loading.end();
    toasts.show((error as Error).message, {
      topic: "scene",
      detail: (error as UploadError).detail,
    });
  }
}

/** Uploads an image for textures. Its name on the server; null where it cannot, which is told. */
export async function uploadImage(
  viewer: Viewer,
  file: File,
  toasts: Toasts,
): Promise<string | null> {
  const error = uploadError(viewer) ?? imageError(viewer, file);
  if (error) {
    toasts.show(error);
    return null;
  }
  await viewer.uploads.refresh("image");
  // Images of the same name are not the same image: "1.png" of one folder and of another.
  const name = viewer.textures.freeName(nameOf(file.name));
  try {
    await upload(viewer.connection.address.url(`api/v1/images/${name}`), file, (fraction) => {
      viewer.loading.start({ kind: "texture", name, stage: "uploading", fraction, by: "" });
    });
    return name;
  } catch (error) {
    viewer.loading.endTexture();
    toasts.show((error as Error).message, {
      topic: "scene",
      detail: (error as UploadError).detail,
    });
    return null;
  }
}

class UploadError extends Error {
  readonly detail: string;

  constructor({ sentence, detail }: FileError) {
    super(sentence);
    this.detail = detail;
  }
}

/** Why no file can be uploaded at the moment; null if it can. */
function uploadError(viewer: Viewer): string | null {
  const { hello } = viewer;
  if (!hello) return "There is no connection to the server";
  if (!viewer.mayChange) return describeControl(viewer.membership.controlState.value);
  return hello.limits.max_upload_bytes === 0 ? uploadsDisabled : null;
}

/** Why this file cannot be uploaded, as far as is known before sending it. */
function fileError(viewer: Viewer, file: File): string | null {
  if (!/\.(glb|hdr|exr)$/i.test(file.name)) {
    return isImage(file)
      ? "Drop an image on a texture of a material, in the panel"
      : "Only .glb files, which contain all buffers and images, and environments (.hdr, .exr) can be uploaded";
  }
  return sizeError(viewer, file);
}

function imageError(viewer: Viewer, file: File): string | null {
  if (!isImage(file)) return "Textures are images: PNG, JPEG, WebP or KTX2 files";
  return sizeError(viewer, file);
}

function isImage(file: File): boolean {
  return /\.(png|jpe?g|webp|ktx2)$/i.test(file.name);
}

function sizeError(viewer: Viewer, file: File): string | null {
  const limit = viewer.hello?.limits.max_upload_bytes ?? Infinity;
  if (file.size > limit) {
    const [size, most] = [formatSize(file.size), formatSize(limit)];
    return `${file.name} has ${size}; the server accepts up to ${most}`;
  }
  return file.size === 0 ? `${file.name} is empty` : null;
}

function formatSize(bytes: number): string {
  const [size, unit] = bytes < megabyte ? [bytes / 1024, "kB"] : [bytes / megabyte, "MB"];
  return `${size.toFixed(size < 10 ? 1 : 0)} ${unit}`;
}

const kindOf = (file: string): "scene" | "environment" =>
  /\.glb$/i.test(file) ? "scene" : "environment";

/** "My model (1).glb" -> "My_model_1": a valid name for the server. */
export function nameOf(file: string): string {
  const stem = file.replace(/\.[^.]*$/, "");
  const name = stem.replace(/[^A-Za-z0-9-]+/g, "_").replace(/^[_-]+|[_-]+$/g, "");
  return name.slice(0, 64) || kindOf(file);
}

/** Rejects with a sentence for the user. XMLHttpRequest, because fetch reports no progress. */
function upload(url: URL, file: File, progress: (fraction: number) => void): Promise<void> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("PUT", url);
    request.upload.onprogress = ({ loaded, total }) => progress(total > 0 ? loaded / total : 0);
    request.onerror = () => reject(new Error("The upload failed: no connection to the server"));
    request.onload = () => {
      if (request.status === 201) resolve();
      else
        reject(new UploadError(rejection(file.name, request.status, request.responseText.trim())));
    };
    progress(0);
    request.send(file);
  });
}

/** Why the server did not take the file. */
function rejection(file: string, status: number, text: string): FileError {
  const plain = (sentence: string): FileError => ({ sentence, detail: "" });
  switch (status) {
    case 400:
      return describeFileError(file, text);
    case 404:
    case 405:
      return plain(uploadsDisabled);
    case 409:
      return plain(`The server has its own ${kindOf(file)} ${nameOf(file)}: rename the file.`);
    case 413:
      return plain(`${file} is larger than the server accepts.`);
    default:
      return plain(text || `The server rejected ${file} (HTTP ${status}).`);
  }
}
