// Annotations: texts pinned to surfaces, with their authors.

import type { Annotation, Snap } from "heliograph/messages.ts";
import { saveFile } from "../../common/image_files.ts";
import { participantName } from "../../common/preferences.ts";
import type { Viewer } from "../../session/viewer.ts";
import { writeAnnotations } from "../../session/marks/annotation_file.ts";
import { importAnnotations } from "../../overlay/annotation_import.ts";
import type { PointTool } from "../../view/point_tool.ts";
import { button, element, setText } from "../../widgets/element.ts";

const maxTextLength = 500;
const taskName = "annotation";

interface AnnotateSection {
  node: HTMLElement;
  /** Begins or ends choosing a place for an annotation. */
  toggle(): void;
}

export function createAnnotateSection(viewer: Viewer, tool: PointTool): AnnotateSection {
  const { annotations } = viewer.marks;
  const form = createForm(viewer);
  const toggle = (): void => {
    if (node.hidden || controls.disabled) return;
    if (tool.task.value?.name === taskName) tool.stop();
    else {
      annotations.draft.set(null);
      tool.start({ name: taskName, count: 1, repeats: false, snaps: false, done: form.write });
    }
  };
  const begin = textButton("Annotate", toggle);
  const hint = element("p", { class: "facts", role: "status" });
  const list = element("ul", { class: "annotations", "aria-label": "Annotations" });
  const clear = textButton("Remove all", () => void annotations.clear());
  const input = element("input", {
    type: "file",
    accept: ".json,application/json",
    hidden: true,
    name: "annotations_file",
    change: () => {
      const file = input.files?.[0];
      if (file) void importAnnotations(viewer, file);
      input.value = "";
    },
  });
  const add = textButton("Import", () => input.click());
  add.dataset.tip = "Adds the annotations of a file that was saved as JSON; it can be dropped, too";
  const controls = element(
    "fieldset",
    { class: "requires-control" },
    begin,
    add,
    input,
    hint,
    form.node,
    list,
    clear,
  );
  const keep = textButton("Save as JSON", () => {
    const scene = viewer.scene.value?.name ?? null;
    saveFile(writeAnnotations(scene, annotations.list.value), "annotations.json");
  });
  const node = element(
    "div",
    { class: "fields annotate", "data-section": "annotate" },
    element("h2", { class: "fields-title" }, "Annotations"),
    controls,
    keep,
  );
  const show = (): void => {
    const all = viewer.scene.value ? annotations.list.value : [];
    list.hidden = keep.hidden = all.length === 0;
    clear.hidden = all.length < 2;
    list.replaceChildren(...all.map((one) => createEntry(viewer, one, show)));
  };
  const showTask = (): void => {
    const placing = tool.task.value?.name === taskName;
    begin.setAttribute("aria-pressed", String(placing));
    setText(hint, placing ? "Click a surface, or P for the middle of the view. Esc ends." : "");
  };
  const enable = (): void => {
    controls.disabled = !viewer.membership.mayAnnotate || !viewer.scene.value;
    if (controls.disabled) annotations.draft.set(null);
  };
  annotations.list.watch(() => {
    // What is being typed in an entry stays.
    if (!list.querySelector("textarea")) show();
  });
  tool.task.watch(showTask);
  viewer.membership.controlState.watch(enable);
  viewer.scene.watch(() => {
    annotations.draft.set(null);
    show();
    enable();
  });
  viewer.capabilities.methods.watch((methods) => {
    node.hidden = !methods.has("annotations.add");
  });
  return { node, toggle };
}

/** Where the text of a new annotation is written; `write` shows it for a point. */
function createForm(viewer: Viewer): { node: HTMLElement; write: (points: Snap[]) => void } {
  const { annotations } = viewer.marks;
  const cancel = (): void => annotations.draft.set(null);
  const add = (): void => {
    const surface = annotations.draft.value?.surface;
    const text = entry.value.trim();
    if (!surface || text === "") return;
    cancel();
    void annotations.add({ surface, text, author: participantName() });
  };
  const entry = element("textarea", {
    name: "annotation",
    rows: "3",
    maxlength: String(maxTextLength),
    "aria-label": "Text of the annotation",
    keydown: (event: KeyboardEvent) => {
      event.stopPropagation();
      if (event.key === "Escape") cancel();
      else if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) add();
    },
  });
  const buttons = element(
    "div",
    { class: "tool-buttons" },
    textButton("Add", add),
    textButton("Cancel", cancel),
  );
  const node = element("div", { class: "annotation-form" }, entry, buttons);
  annotations.draft.watch((draft) => (node.hidden = draft === null));
  const write = ([point]: Snap[]): void => {
    annotations.draft.set(point ?? null);
    entry.value = "";
    entry.focus();
  };
  return { node, write };
}

function textButton(label: string, click: () => void): HTMLButtonElement {
  return element("button", { type: "button", class: "button quiet", click }, label);
}

/** `reset` shows the annotations again as they are. */
function createEntry(viewer: Viewer, annotation: Annotation, reset: () => void): HTMLElement {
  const { id, text, author } = annotation;
  const said = element("span", { class: "annotation-text" }, text);
  const short = text.length > 30 ? `${text.slice(0, 30)}…` : text;
  const edit = button(`Edit ${short}`, "pencil", () => {
    let cancelled = false;
    const entry = element("textarea", {
      rows: "3",
      maxlength: String(maxTextLength),
      "aria-label": `Text of annotation ${id}`,
      keydown: (event: KeyboardEvent) => {
        event.stopPropagation();
        cancelled = event.key === "Escape";
        if (cancelled || (event.key === "Enter" && (event.ctrlKey || event.metaKey))) entry.blur();
      },
      blur: () => {
        const { annotations } = viewer.marks;
        const edited = cancelled ? null : annotations.edit(annotation, entry.value.trim());
        entry.remove();
        void Promise.resolve(edited).then(reset);
      },
    });
    entry.value = text;
    said.replaceWith(entry);
    entry.focus();
  });
  const remove = button(`Remove ${short}`, "close", () => {
    void viewer.marks.annotations.remove(annotation);
  });
  return element(
    "li",
    { "data-annotation": String(id) },
    element("div", {}, element("b", {}, author || "Without a name"), said),
    edit,
    remove,
  );
}
