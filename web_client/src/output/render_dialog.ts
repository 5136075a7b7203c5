// The dialog that has the server render the view into files, as a job.

import { type Viewer } from "../session/viewer.ts";
import type { Path } from "../view/path_player.ts";
import { button, element, setOptions, setText } from "../widgets/element.ts";
import { field } from "../widgets/field.ts";
import { type RenderWish, leftOut, renderJob, videoFormats } from "./render_request.ts";
import { createSizeFields } from "./size_fields.ts";

const imageFormats = [
  { value: "png", label: "PNG, without loss" },
  { value: "jpeg", label: "JPEG, smaller" },
  { value: "webp", label: "WebP" },
];
const videoAndFrameFormats = [
  { value: "mp4", label: "Video, MP4" },
  { value: "webm", label: "Video, WebM" },
  { value: "animated_webp", label: "Animated WebP" },
  { value: "png", label: "Numbered images, PNG" },
];
const qualities = [
  { value: "0.95", label: "Draft: similarity 0.95" },
  { value: "0.98", label: "Good: similarity 0.98" },
  { value: "0.995", label: "Best: similarity 0.995" },
  { value: "", label: "All samples of the settings" },
];
const turns = [
  { value: "", label: "One image" },
  { value: "36", label: "Turntable, 36 frames" },
  { value: "72", label: "Turntable, 72 frames" },
  { value: "144", label: "Turntable, 144 frames" },
];
const pathChoice = "path";
const pathOption = { value: pathChoice, label: "Path through the bookmarks" };
const keepAlpha: ReadonlySet<string> = new Set(["png", "webp", "animated_webp"]);

interface RenderHost {
  /** The file's name without its ending. */
  fileStem(): string;
  /** The page of jobs. */
  jobsPage(): string;
  /** Through the bookmarks; null without. */
  path(): Path | null;
}

export function createRenderDialog(
  dialog: HTMLDialogElement,
  viewer: Viewer,
  host: RenderHost,
): { open(): void } {
  const select = (name: string): HTMLSelectElement => element("select", { name });
  const [turn, format, quality, rate] = ["turntable", "format", "quality", "rate"].map(select) as [
    HTMLSelectElement,
    HTMLSelectElement,
    HTMLSelectElement,
    HTMLSelectElement,
  ];
  const size = createSizeFields();
  const transparent = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "transparent",
  });
  const background = field("Transparent", transparent);
  const frameRate = field("Frames per s", rate);
  const note = element("p", { class: "save-status" });
  const status = element("p", { class: "save-status", role: "status" });
  const render = element("button", { type: "submit", class: "button" }, "Render");
  const close = element("button", { type: "button", class: "button quiet" }, "Close");
  const form = element(
    "form",
    { method: "dialog" },
    field("Content", turn),
    field("Format", format),
    size.node,
    field("Quality", quality),
    frameRate,
    background,
    note,
    status,
    element("footer", {}, close, render),
  );
  dialog.append(
    element(
      "header",
      {},
      element("h1", { id: "render-title" }, "Render this view"),
      button("Close", "close", () => dialog.close()),
    ),
    form,
  );
  setOptions(quality, qualities);
  setOptions(
    rate,
    ["12", "24", "30", "60"].map((value) => ({ value, label: value })),
  );
  [quality.value, rate.value] = ["0.98", "30"];

  let offered: typeof imageFormats | null = null;
  const update = (): void => {
    const formats = turn.value === "" ? imageFormats : videoAndFrameFormats;
    if (formats !== offered) {
      offered = formats;
      setOptions(format, formats);
      format.value = (formats[0] as { value: string }).value;
    }
    const output = String(viewer.settings.value("view.buffer") ?? "output") === "output";
    frameRate.hidden = !videoFormats.has(format.value as RenderWish["format"]);
    background.hidden = !output || !keepAlpha.has(format.value);
    quality.disabled = !output;
  };

  const wish = (): RenderWish => ({
    size: size.value(),
    quality: quality.value === "" ? null : Number(quality.value),
    transparent: transparent.checked && !background.hidden,
    format: format.value as RenderWish["format"],
    turntable: turn.value === "" || turn.value === pathChoice ? null : Number(turn.value),
    path: turn.value === pathChoice ? host.path() : null,
    fps: Number(rate.value),
  });

  const run = async (): Promise<void> => {
    render.disabled = true;
    setText(status, "");
    try {
      const known = viewer.capabilities.has("edits.get");
      const edits = known ? await viewer.parts.readEdits() : null;
      const request = renderJob(viewer.viewState(), host.fileStem(), wish(), edits);
      const job = await viewer.rpc.request("job.create", request);
      status.replaceChildren(
        `“${job.name}” was queued. `,
        element("a", { href: host.jobsPage(), target: "_blank" }, "Show the jobs"),
      );
    } catch (error) {
      setText(status, "The job was not created.");
      viewer.report(error);
    } finally {
      render.disabled = false;
    }
  };

  form.addEventListener("change", update);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (!render.disabled) void run();
  });
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return {
    open() {
      if (dialog.open) return;
      const chosen = turn.value;
      setOptions(turn, host.path() ? [...turns, pathOption] : turns);
      turn.value = turns.some(({ value }) => value === chosen) ? chosen : "";
      const limits = viewer.hello?.limits;
      const { width, height } = viewer.stream.settings.value ?? { width: 1280, height: 720 };
      size.show(
        { width, height },
        { width: limits?.max_width ?? width, height: limits?.max_height ?? height },
      );
      setText(note, leftOut(viewer.viewState()));
      setText(status, "");
      dialog.showModal();
      update();
    },
  };
}
