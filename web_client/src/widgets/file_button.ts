// A button that opens the browser's file chooser: an alternative to dropping a file. Hidden where
// the server does not accept uploads.

import type { Viewer } from "../session/viewer.ts";
import { button, element } from "./element.ts";

interface FileButton {
  label: string;
  tip: string;
  /** Extensions of the files, separated by commas. */
  accept: string;
  upload(file: File): void;
}

export function createFileButton(
  viewer: Viewer,
  { label, tip, accept, upload }: FileButton,
): HTMLElement {
  const input = element("input", {
    type: "file",
    accept,
    hidden: true,
    change: () => {
      const file = input.files?.[0];
      if (file) upload(file);
      input.value = "";
    },
  });
  const opener = button(label, "upload", () => input.click());
  opener.dataset.tip = tip;
  opener.hidden = true;
  viewer.connection.state.watch((state) => {
    if (state.kind === "live") opener.hidden = !state.hello.limits.max_upload_bytes;
  });
  return element("span", { class: "file-button" }, opener, input);
}
