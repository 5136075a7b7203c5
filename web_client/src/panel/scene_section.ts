// What is shown: scene, camera and buffer, and a picture of it to keep.

import type { Capture, SceneInfo } from "../protocol/messages.ts";
import { humanise } from "../protocol/settings_schema.ts";
import { type Viewer, bufferSetting } from "../viewer.ts";
import { button, element, icon, setOptions, setText } from "./element.ts";
import { field } from "./field.ts";

const freeView = "";

export function createSceneSection(viewer: Viewer): HTMLElement {
  const facts = element("p", { class: "facts" });
  const warnings = element("details", { class: "warnings", hidden: true });
  viewer.scene.watch((scene) => {
    setText(facts, scene ? describeScene(scene) : "");
    showWarnings(warnings, scene?.warnings ?? []);
  });
  return element(
    "div",
    { class: "fields", "data-section": "scene" },
    field("Scene", scenePicker(viewer)),
    facts,
    warnings,
    field("Camera", cameraPicker(viewer), fitButton(viewer)),
    field("Buffer", bufferPicker(viewer), saveButton(viewer)),
  );
}

function scenePicker(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "scene",
    change: () => void viewer.loadScene(select.value),
    focus: () => void viewer.refreshScenes(),
  });
  const update = (): void => {
    const { scenes, current } = viewer.scenes.value;
    const loading = viewer.loading.value;
    const options = scenes.map(({ name }) => ({ value: name, label: name }));
    if (scenes.length === 0) {
      options.push({ value: "", label: viewer.hello ? "No scenes found" : "–" });
    }
    else if (!current && !loading) options.unshift({ value: "", label: "Choose a scene" });
    setOptions(select, options);
    select.value = loading?.name ?? current ?? "";
    select.disabled = loading !== null || scenes.length === 0;
  };
  viewer.scenes.watch(update);
  viewer.loading.watch(update);
  viewer.connection.state.watch(update);
  return select;
}

function cameraPicker(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "camera",
    change: () => {
      if (select.value !== freeView) void viewer.selectCamera(select.value);
    },
  });
  const update = (): void => {
    const names = viewer.scene.value?.cameras ?? [];
    setOptions(select, [
      { value: freeView, label: "Free view" },
      ...names.map((name) => ({ value: name, label: name })),
    ]);
    const current = viewer.camera.value?.name ?? freeView;
    select.value = names.includes(current) ? current : freeView;
    select.disabled = names.length === 0;
  };
  viewer.scene.watch(update);
  viewer.camera.watch(update);
  return select;
}

function fitButton(viewer: Viewer): HTMLElement {
  return button("Fit the scene into view (F)", "fit", () => void viewer.fitCamera());
}

function bufferPicker(viewer: Viewer): HTMLSelectElement {
  const select = element("select", {
    name: "buffer",
    change: () => viewer.settings.change(bufferSetting, select.value),
  });
  const update = (): void => {
    const shown = String(viewer.settings.value(bufferSetting) ?? "output");
    const buffers = viewer.buffers.value;
    const known = buffers.some(({ name }) => name === shown);
    const names = known ? buffers.map(({ name }) => name) : [shown, ...buffers.map((b) => b.name)];
    setOptions(
      select,
      names.map((name) => ({ value: name, label: humanise(name.replaceAll(".", " · ")) })),
    );
    select.value = shown;
    select.dataset.tip =
      buffers.find(({ name }) => name === shown)?.description || "Which picture to show";
  };
  viewer.buffers.watch(update);
  viewer.settings.tree.watch(update);
  return select;
}

function saveButton(viewer: Viewer): HTMLElement {
  const save = element(
    "button",
    {
      type: "button",
      class: "icon-button",
      "aria-label": "Save this picture as PNG",
      "data-tip": "Save this picture as PNG",
      click: () => void run(),
    },
    icon("save"),
  );
  const run = async (): Promise<void> => {
    save.disabled = true;
    save.classList.add("busy");
    try {
      download(await viewer.capture(), viewer.scene.value?.name ?? "scene");
    } catch (error) {
      viewer.report(error);
    } finally {
      save.disabled = false;
      save.classList.remove("busy");
    }
  };
  return save;
}

function download(capture: Capture, scene: string): void {
  const bytes = Uint8Array.from(atob(capture.data), (letter) => letter.charCodeAt(0));
  const url = URL.createObjectURL(new Blob([bytes], { type: `image/${capture.format}` }));
  const stem = scene.replace(/\.[^./]+$/, "").replace(/[^\w.-]+/g, "_");
  const suffix = capture.buffer === "output" ? "" : `-${capture.buffer}`;
  element("a", { href: url, download: `${stem}${suffix}.${capture.format}` }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

function describeScene(scene: SceneInfo): string {
  const count = (value: number, one: string): string =>
    value > 0 ? `${compact(value)} ${one}${value === 1 ? "" : "s"}` : "";
  return [
    count(scene.triangles, "triangle"),
    count(scene.materials, "material"),
    count(scene.textures, "texture"),
    count(scene.lights, "light"),
  ]
    .filter(Boolean)
    .join(" · ");
}

function compact(value: number): string {
  if (value >= 1e6) return `${(value / 1e6).toFixed(1)} M`;
  return value >= 10_000 ? `${Math.round(value / 1000)} k` : String(value);
}

function showWarnings(node: HTMLDetailsElement, warnings: string[]): void {
  node.hidden = warnings.length === 0;
  const noun = warnings.length === 1 ? "warning" : "warnings";
  node.replaceChildren(
    element("summary", {}, icon("warning"), `${warnings.length} ${noun} in this file`),
    element("ul", {}, ...warnings.map((text) => element("li", {}, text))),
  );
}
