// Saves what differs from the scene's file as a small document, and opens such a document.

import type { EditDocument } from "heliograph/messages.ts";
import { saveFile } from "../../common/image_files.ts";
import type { Viewer } from "../../session/viewer.ts";
import { element, setText } from "../../widgets/element.ts";
import { createSection } from "../../widgets/section.ts";

export function createEditsSection(viewer: Viewer): HTMLElement {
  const { parts } = viewer;
  const save = async (): Promise<void> => {
    const edits = await parts.readEdits();
    if (!edits) return;
    const text = `${JSON.stringify(edits, null, 2)}\n`;
    saveFile(new Blob([text], { type: "application/json" }), fileName(viewer));
  };
  const open = async (file: File): Promise<void> => {
    setText(status, "");
    const edits = await read(file);
    const applied = edits !== null && (await parts.applyEdits(edits));
    if (applied) setText(status, `${file.name} is applied`);
    else if (!edits) setText(status, `${file.name} is no JSON document`);
  };
  const input = element("input", {
    type: "file",
    accept: ".json,application/json",
    hidden: true,
    name: "edits_file",
    change: () => {
      const file = input.files?.[0];
      if (file) void open(file);
      input.value = "";
    },
  });
  const status = element("p", { class: "facts", role: "status" });
  const section = createSection({
    id: "edits",
    title: "Edits",
    body: element(
      "div",
      { class: "section-body" },
      element(
        "div",
        { class: "tool-buttons" },
        textButton("Save edits", () => void save()),
        textButton("Open edits", () => input.click()),
        input,
      ),
      status,
    ),
    openByDefault: false,
  });
  const update = (): void => {
    section.hidden = !viewer.scene.value || !viewer.capabilities.has("edits.apply");
    setText(status, "");
  };
  viewer.scene.watch(update);
  viewer.capabilities.methods.watch(update);
  return section;
}

function textButton(label: string, click: () => void): HTMLButtonElement {
  return element("button", { type: "button", class: "button quiet", click }, label);
}

/** The server checks what is in it. */
async function read(file: File): Promise<EditDocument | null> {
  try {
    return JSON.parse(await file.text()) as EditDocument;
  } catch {
    return null;
  }
}

function fileName({ scene }: Viewer): string {
  const stem = scene.value?.name.split("/").pop() ?? "scene";
  return `${stem}_edits.json`;
}
