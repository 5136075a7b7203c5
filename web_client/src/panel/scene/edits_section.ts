// Saves what differs from the scene's file as a small document, opens such a document, and exports
// the scene with it as a new file.

import type { EditDocument } from "heliograph/messages.ts";
import { saveFile } from "../../common/image_files.ts";
import { downloadScene } from "../../output/scene_download.ts";
import type { Viewer } from "../../session/viewer.ts";
import { element, setText } from "../../widgets/element.ts";
import { createSection } from "../../widgets/section.ts";

const exportLabel = "Export as .glb";

export function createEditsSection(viewer: Viewer): HTMLElement {
  const { parts } = viewer;
  const save = async (): Promise<void> => {
    const edits = await parts.readEdits();
    if (!edits) return;
    const text = `${JSON.stringify(edits, null, 2)}\n`;
    saveFile(new Blob([text], { type: "application/json" }), fileName(viewer, "edits.json"));
  };
  const open = async (file: File): Promise<void> => {
    setText(status, "");
    const edits = await read(file);
    const applied = edits !== null && (await parts.applyEdits(edits));
    if (applied) setText(status, `${file.name} is applied`);
    else if (!edits) setText(status, `${file.name} is no JSON document`);
  };
  let running: AbortController | null = null;
  const exportScene = async (): Promise<void> => {
    const own = (running = new AbortController());
    const name = fileName(viewer, "edited.glb");
    setText(exportButton, "Cancel the export");
    showLacking([]);
    setText(status, `The server writes ${name}`);
    try {
      const url = viewer.connection.address.url(
        `api/v1/sessions/${encodeURIComponent(viewer.membership.name)}/scene.glb`,
      );
      const { file, warnings } = await downloadScene(url, own.signal, (received, total) => {
        setText(status, `${name}: ${megabytes(received)} of ${megabytes(total)} MB`);
      });
      saveFile(file, name);
      setText(status, warnings.length > 0 ? `${name} is saved, but lacks:` : `${name} is saved`);
      showLacking(warnings);
    } catch (error) {
      const why = error instanceof Error ? error.message : String(error);
      if (running === own) setText(status, own.signal.aborted ? "" : `Not exported: ${why}`);
    } finally {
      if (running === own) {
        running = null;
        setText(exportButton, exportLabel);
      }
    }
  };
  const exportButton = textButton(exportLabel, () => {
    if (running) running.abort();
    else void exportScene();
  });
  const lacking = element("ul", { class: "facts", hidden: true });
  const showLacking = (warnings: string[]): void => {
    lacking.hidden = warnings.length === 0;
    lacking.replaceChildren(...warnings.map((text) => element("li", {}, text)));
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
        exportButton,
        input,
      ),
      status,
      lacking,
    ),
    openByDefault: false,
  });
  const update = (): void => {
    section.hidden = !viewer.scene.value || !viewer.capabilities.has("edits.apply");
    running?.abort();
    setText(status, "");
    showLacking([]);
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

function fileName({ scene }: Viewer, ending: string): string {
  const stem = scene.value?.name.split("/").pop() ?? "scene";
  return `${stem}_${ending}`;
}

function megabytes(bytes: number): string {
  return (bytes / 1e6).toFixed(1);
}
