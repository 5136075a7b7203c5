// What one takes away from here: pictures, a recording, a link, a snippet for another page.

import { copyText } from "../common/clipboard.ts";
import { linkTo } from "../session/view_link.ts";
import type { MenuItem } from "../widgets/menu.ts";
import { captureBlob, saveFile } from "../common/image_files.ts";
import { Recorder } from "./recorder.ts";
import type { Viewer } from "../session/viewer.ts";

export interface OutputHost {
  /** Says in one sentence what was done. */
  tell(message: string): void;
}

export function outputActions(viewer: Viewer, host: OutputHost): MenuItem[] {
  const attempt = (action: () => Promise<void>) => () => {
    void action().catch((error: unknown) => viewer.report(error));
  };
  const recorder = new Recorder(viewer);
  const save = (format: string) =>
    attempt(async () => {
      host.tell(`The ${format.toUpperCase()} is being rendered`);
      const capture = await viewer.capture(undefined, format);
      const suffix = capture.buffer === "output" ? "" : `-${capture.buffer}`;
      saveFile(captureBlob(capture), `${fileStem(viewer)}${suffix}.${format}`);
    });
  return [
    { label: "Save picture as PNG", icon: "save", run: save("png") },
    {
      label: "Save picture as EXR",
      icon: "save",
      run: save("exr"),
      offered: () => viewer.capabilities.captureFormats.value.has("exr"),
    },
    {
      label: "Copy picture",
      icon: "copy",
      run: attempt(async () => {
        const picture = viewer.capture().then(captureBlob);
        await navigator.clipboard.write([new ClipboardItem({ "image/png": picture })]);
        host.tell("The picture is in the clipboard");
      }),
      offered: () => "clipboard" in navigator && typeof ClipboardItem === "function",
    },
    {
      label: "Record a clip",
      labelNow: () => (recorder.running ? "Stop recording" : "Record a clip"),
      icon: "record",
      run: attempt(async () => {
        if (!recorder.running) {
          await recorder.start();
          host.tell("Recording: choose Stop recording to save it");
          return;
        }
        saveFile(await recorder.stop(), `${fileStem(viewer)}.webm`);
      }),
      offered: () => Recorder.possible,
    },
    {
      label: "Copy link to this view",
      icon: "link",
      run: attempt(async () => {
        const { href, shortened } = linkTo(location.href, viewer.viewState());
        await copyText(href);
        host.tell(
          shortened
            ? "The link is in the clipboard, without all the changed materials: they are too many"
            : "The link to this view is in the clipboard",
        );
      }),
    },
    {
      label: "Copy code to embed",
      icon: "code",
      run: attempt(async () => {
        const link = linkTo(location.href, viewer.viewState()).href.replaceAll("&", "&amp;");
        const title = (viewer.scene.value?.name ?? "Heliograph").replaceAll('"', "&quot;");
        await copyText(
          `<iframe src="${link}" title="${title}" width="960" height="540" ` +
            `style="border:0" allow="fullscreen; clipboard-write"></iframe>`,
        );
        host.tell("The code is in the clipboard; the server must allow the page it is put on");
      }),
    },
  ];
}

function fileStem(viewer: Viewer): string {
  const scene = viewer.scene.value?.name ?? "scene";
  return scene.replace(/\.[^./]+$/, "").replace(/[^\w.-]+/g, "_");
}
