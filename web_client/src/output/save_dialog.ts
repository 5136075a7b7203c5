// The dialog that saves the view as an image: format, samples, what it shows, progress, cancelling.

import { saveFile, captureBlob } from "../common/image_files.ts";
import {
  refinementOf,
  refinementText,
  referenceFollows,
  shownSamples,
} from "../session/refinement.ts";
import { type Viewer, bufferSetting } from "../session/viewer.ts";
import { button, element, setOptions, setText } from "../widgets/element.ts";
import { field } from "../widgets/field.ts";
import { type Wanted, captureInSize, captureWithoutBackground, leastSamples } from "./sized_capture.ts";
import { type ImageSize, createSizeFields } from "./size_fields.ts";

interface SaveHost {
  /** The file's name without its ending. */
  fileStem(): string;
  /** Shows the result as one sentence. */
  inform(message: string): void;
}

const formats = [
  { value: "png", label: "PNG, without loss" },
  { value: "jpeg", label: "JPEG, smaller" },
  { value: "exr", label: "EXR, linear radiance and layers" },
] as const;
type Format = (typeof formats)[number]["value"];

interface RenderedImage {
  file: Blob;
  buffer: string;
  width: number;
  height: number;
  samples: number;
}

export function createSaveDialog(
  dialog: HTMLDialogElement,
  viewer: Viewer,
  host: SaveHost,
): { open(): void } {
  const format = element("select", { name: "format" });
  const samples = element("select", { name: "samples" });
  const size = createSizeFields();
  const transparent = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "transparent",
  });
  const background = field("Transparent", transparent);
  // The dialog stays in the page, and so does the choice.
  const marks = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "marks",
  });
  const drawnMarks = field("Measurements and annotations", marks);
  const bar = element("div", { class: "bar" });
  const progress = element(
    "div",
    { class: "progress", role: "progressbar", "aria-label": "Rendering", hidden: true },
    bar,
  );
  const status = element("p", { class: "save-status", role: "status" });
  const save = element("button", { type: "submit", class: "button" }, "Save");
  const cancel = element("button", { type: "button", class: "button quiet" }, "Cancel");
  const form = element(
    "form",
    { method: "dialog" },
    field("Format", format),
    field("Samples", samples),
    size.node,
    background,
    drawnMarks,
    progress,
    status,
    element("footer", {}, cancel, save),
  );
  dialog.append(
    element(
      "header",
      {},
      element("h1", { id: "save-title" }, "Save image"),
      button("Close", "close", () => dialog.close()),
    ),
    form,
  );

  /** Counts saves: the result of one that was cancelled is not written. */
  let attempt = 0;
  let isSaving = false;
  /** The running capture in another size, and its samples so far. */
  let sized: AbortController | null = null;
  let sizedSamples = 0;
  /** Called with the final frame of the view. */
  let whenFinal: (() => void) | null = null;
  /** Whether an image without background is being rendered: it does not report its samples. */
  let withoutBackground = false;

  const viewSize = (): ImageSize => {
    const { width, height } = viewer.stream.settings.value ?? { width: 0, height: 0 };
    return { width, height };
  };
  const hasViewSize = (): boolean => {
    const [{ width, height }, view] = [size.value(), viewSize()];
    return width === view.width && height === view.height;
  };
  const samplesNow = (): number => viewer.frame.value?.samples ?? 1;
  const shownBuffer = (): string => String(viewer.settings.value(bufferSetting) ?? "output");
  const showsOutput = (): boolean => shownBuffer() === "output";

  /** Where the reference follows, what comes before it can be had much sooner. */
  const sampleOptions = (): { value: string; label: string }[] => {
    const now = samplesNow();
    const final = viewer.frame.value?.final ?? false;
    const follows = referenceFollows(viewer.settings) && !withoutReference();
    const { pathTraced } = refinementOf(now, viewer.settings);
    const { of } = refinementOf(0, viewer.settings);
    const last = refinementOf(Infinity, viewer.settings).of;
    const finished = follows ? `${last} path traced samples` : "when finished";
    const before = follows && (!hasViewSize() || (!pathTraced && !final));
    return [
      { value: "now", label: `As it is now: ${shownSamples(now, viewer.settings)}` },
      ...(before ? [{ value: "hybrid", label: `Quick: ${of} samples` }] : []),
      { value: "converged", label: `Converged: ${final ? "now" : finished}` },
    ];
  };
  /** Images without background are rendered without path traced samples. */
  const withoutReference = (): boolean => transparent.checked && !background.hidden;

  const hasMarks = (): boolean => {
    const { measurements, annotations } = viewer.marks;
    return measurements.list.value.length + annotations.list.value.length > 0;
  };
  const withMarks = (): boolean => marks.checked && !drawnMarks.hidden;

  const update = (): void => {
    if (viewer.frame.value?.final) whenFinal?.();
    if (!dialog.open) return;
    if (!isSaving) {
      const possible = viewer.mayCreateSessions && format.value === "png" && showsOutput();
      transparent.disabled = !possible;
      background.hidden = !possible;
      drawnMarks.hidden = !hasMarks() || format.value === "exr" || !showsOutput();
      marks.disabled = drawnMarks.hidden;
      setOptions(samples, sampleOptions());
      return;
    }
    if (withoutBackground) {
      progress.removeAttribute("aria-valuenow");
      setText(status, "Rendering without the background");
      return;
    }
    const now = Math.max(samplesNow(), viewer.stats.value?.samples ?? 0);
    const refinement = refinementOf(sized ? sizedSamples : now, viewer.settings);
    const final = !sized && viewer.frame.value?.final;
    const share = final ? 1 : Math.min(1, refinement.samples / refinement.of);
    bar.style.width = `${share * 100}%`;
    progress.setAttribute("aria-valuenow", String(Math.round(share * 100)));
    setText(status, `Rendering: ${refinementText(refinement)}`);
  };
  viewer.frame.watch(update);
  viewer.stats.watch(update);
  viewer.marks.measurements.list.watch(update);
  viewer.marks.annotations.list.watch(update);

  const setSaving = (saving: boolean): void => {
    isSaving = saving;
    for (const control of [format, samples, transparent, marks, save]) control.disabled = saving;
    size.enable(!saving && viewer.mayCreateSessions);
    progress.hidden = !saving;
    progress.classList.toggle("indeterminate", saving && withoutBackground);
    bar.style.width = withoutBackground ? "" : "0";
    setText(status, "");
    update();
  };

  /** The view's own size is captured from its session, any other one from a copy. */
  const render = async (chosen: Format, wanted: Wanted): Promise<RenderedImage> => {
    const { width, height } = size.value();
    if (!withoutBackground && hasViewSize()) {
      if (wanted === "final") await finalFrame();
      const capture = await viewer.queries.capture(
        undefined,
        chosen,
        leastSamples(wanted),
        withMarks(),
      );
      return { ...capture, file: captureBlob(capture) };
    }
    const buffer = shownBuffer();
    const extension = extensionOf(chosen);
    const request = { width, height, buffer, extension, wanted, marks: withMarks() };
    sized = new AbortController();
    sizedSamples = 0;
    update();
    try {
      const { signal } = sized;
      const capture = withoutBackground
        ? await captureWithoutBackground(viewer, request, signal)
        : await captureInSize(viewer, request, signal, (count) => {
            sizedSamples = count;
            update();
          });
      return { ...capture, width, height, buffer };
    } finally {
      sized = null;
    }
  };

  /** Captures themselves do not wait for path traced samples. */
  const finalFrame = (): Promise<void> =>
    new Promise((resolve) => {
      whenFinal = () => {
        whenFinal = null;
        resolve();
      };
      update();
    });

  const run = async (): Promise<void> => {
    attempt += 1;
    const own = attempt;
    const chosen = format.value as Format;
    const follows = referenceFollows(viewer.settings) && !withoutReference();
    const whole = follows && samples.value === "converged" ? "final" : "hybrid";
    const wanted = samples.value === "now" ? samplesNow() : whole;
    withoutBackground = withoutReference();
    setSaving(true);
    try {
      const image = await render(chosen, wanted);
      if (own !== attempt) return;
      const suffix = image.buffer === "output" ? "" : `-${image.buffer}`;
      const name = `${host.fileStem()}${suffix}.${extensionOf(chosen)}`;
      saveFile(image.file, name);
      const { width, height } = image;
      host.inform(`Saved ${name}: ${width} x ${height} pixels, ${shownSamples(image.samples, viewer.settings)}`);
      dialog.close();
    } catch (error) {
      if (own !== attempt) return;
      setSaving(false);
      viewer.report(error);
    }
  };

  format.addEventListener("change", update);
  transparent.addEventListener("change", update);
  size.node.addEventListener("change", update);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (!isSaving) void run();
  });
  cancel.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  dialog.addEventListener("close", () => {
    attempt += 1;
    sized?.abort();
    whenFinal = null;
    withoutBackground = false;
    setSaving(false);
  });
  return {
    open() {
      if (dialog.open) return;
      const available = viewer.capabilities.captureFormats.value;
      setOptions(format, [...formats.filter(({ value }) => available.has(value))]);
      format.value ||= "png";
      const limits = viewer.hello?.limits;
      const most = { width: limits?.max_width ?? 0, height: limits?.max_height ?? 0 };
      size.show(viewSize(), most);
      size.enable(viewer.mayCreateSessions);
      dialog.showModal();
      update();
      samples.value ||= "now";
    },
  };
}

const extensionOf = (format: Format): "png" | "jpg" | "exr" => (format === "jpeg" ? "jpg" : format);
