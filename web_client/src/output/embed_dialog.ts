// The dialog with code that shows this view in another page.

import { copyText } from "../common/clipboard.ts";
import { embedSnippet, frameSnippet } from "../embed/snippet.ts";
import { linkTo } from "../session/view_link.ts";
import type { Viewer } from "../session/viewer.ts";
import { button, element } from "../widgets/element.ts";
import { field } from "../widgets/field.ts";

const kinds = [
  { value: "component", label: "Web component" },
  { value: "frame", label: "Frame, without a script" },
];

export function createEmbedDialog(
  dialog: HTMLDialogElement,
  viewer: Viewer,
  inform: (message: string) => void,
): { open(): void } {
  const kind = element(
    "select",
    { name: "embed_kind", change: () => update() },
    ...kinds.map(({ value, label }) => element("option", { value }, label)),
  );
  const code = element("textarea", {
    readonly: true,
    rows: "7",
    spellcheck: "false",
    "aria-label": "Code",
    focus: () => code.select(),
  });
  const note = element(
    "p",
    { class: "save-status" },
    "It shows this view in a session of its own. The server must allow the other page with ",
    element("code", {}, "--frame-ancestors"),
    ".",
  );
  const update = (): void => {
    const { href } = linkTo(location.href, viewer.viewState());
    const scene = viewer.scene.value?.name ?? "";
    code.value =
      kind.value === "frame"
        ? frameSnippet(href, scene || "Heliograph")
        : embedSnippet(location.href, scene, new URL(href).hash.slice(1));
  };
  const copy = element("button", { type: "submit", class: "button" }, "Copy");
  const form = element(
    "form",
    {
      method: "dialog",
      submit: (event: Event) => {
        event.preventDefault();
        copyText(code.value).then(
          () => {
            inform("Code copied to the clipboard");
            dialog.close();
          },
          (error: unknown) => viewer.report(error),
        );
      },
    },
    field("Kind", kind),
    code,
    note,
    element("footer", {}, copy),
  );
  dialog.append(
    element(
      "header",
      {},
      element("h1", { id: "embed-title" }, "Embed"),
      button("Close", "close", () => dialog.close()),
    ),
    form,
  );
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return {
    open() {
      if (dialog.open) return;
      update();
      dialog.showModal();
    },
  };
}
