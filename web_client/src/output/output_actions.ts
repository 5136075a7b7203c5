// The "Save and share" menu: images, recordings, links, code to embed.

import { copyText } from "../common/clipboard.ts";
import { captureBlob, saveFile } from "../common/image_files.ts";
import { linkTo } from "../session/view_link.ts";
import type { Viewer } from "../session/viewer.ts";
import { element, setText } from "../widgets/element.ts";
import type { MenuItem } from "../widgets/menu.ts";
import { Recorder } from "./recorder.ts";

interface OutputHost {
  /** Where the duration of a recording is shown. */
  recordingButton: HTMLElement;
  /** Opens the dialog that saves an image. */
  save(): void;
  /** Opens the dialog that has the server render the view. */
  render(): void;
  /** The page of jobs. */
  jobsPage(): string;
  /** Opens the dialog with code for other pages. */
  embed(): void;
  /** Shows the result as one sentence. */
  inform(message: string): void;
}

export function outputActions(viewer: Viewer, host: OutputHost): MenuItem[] {
  const attempt = (action: () => Promise<void>) => () => {
    void action().catch((error: unknown) => viewer.report(error));
  };
  const recorder = new Recorder(viewer);
  const toggleRecording = attempt(async () => {
    if (!recorder.running) await recorder.start();
    else {
      const { video, extension } = await recorder.stop();
      saveFile(video, `${fileStem(viewer)}.${extension}`);
      host.inform(`Saved ${fileStem(viewer)}.${extension}`);
    }
  });
  mountRecordingButton(recorder, host.recordingButton, toggleRecording);
  return [
    { label: "Save image", icon: "save", run: host.save },
    {
      label: "Render this view",
      icon: "image",
      run: host.render,
      isAvailable: () => viewer.capabilities.jobs && viewer.hello?.role === "control",
    },
    {
      label: "Copy image",
      icon: "copy",
      run: attempt(async () => {
        const image = viewer.queries.capture().then(captureBlob);
        await navigator.clipboard.write([new ClipboardItem({ "image/png": image })]);
        host.inform("Image copied to the clipboard");
      }),
      isAvailable: () => "clipboard" in navigator && typeof ClipboardItem === "function",
    },
    {
      label: "Record a video",
      currentLabel: () => (recorder.running ? "Stop recording" : "Record a video"),
      icon: "record",
      run: toggleRecording,
      isAvailable: () => Recorder.possible,
    },
    {
      label: "Copy link to this view",
      icon: "link",
      run: attempt(async () => {
        const { href, shortened } = linkTo(location.href, viewer.viewState());
        await copyText(href);
        host.inform(
          shortened
            ? "Link copied. It does not contain all changed materials and textures: there are too many."
            : "Link copied to the clipboard",
        );
      }),
    },
    { label: "Embed in another page", icon: "code", run: host.embed },
    {
      label: "Jobs of this server",
      icon: "external",
      run: () => window.open(host.jobsPage(), "_blank", "noopener"),
      isAvailable: () => viewer.capabilities.jobs,
    },
    {
      label: "API of this server",
      icon: "external",
      run: () => window.open(new URL("api", document.baseURI), "_blank", "noopener"),
    },
  ];
}

/** A button that shows the duration of the recording, and stops it. */
function mountRecordingButton(recorder: Recorder, root: HTMLElement, stop: () => void): void {
  const duration = element("span");
  const button = element(
    "button",
    { type: "button", class: "recording-button", "data-tip": "Stop recording", click: stop },
    element("span", { class: "dot" }),
    duration,
  );
  root.append(button);
  recorder.seconds.watch((seconds) => {
    root.hidden = seconds === null;
    const text = formatDuration(seconds ?? 0);
    setText(duration, `Recording ${text}`);
    button.setAttribute("aria-label", `Stop recording, ${text}`);
  });
}

/** 75 -> "1:15" */
function formatDuration(seconds: number): string {
  return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
}

/** The scene's name as the name of a file. */
export function fileStem(viewer: Viewer): string {
  const scene = viewer.scene.value?.name ?? "scene";
  return scene.replace(/\.[^./]+$/, "").replace(/[^\w.-]+/g, "_");
}
