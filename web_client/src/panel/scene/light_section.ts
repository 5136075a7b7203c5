// The lights of the scene: edits one, adds and removes others.

import type { LightInfo, LightPatch } from "heliograph/messages.ts";
import { displayColour, linearColour } from "../../common/colour.ts";
import { humanise } from "heliograph/settings_schema.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createSection, watchUnfolded } from "../../widgets/section.ts";
import { createLightRows } from "./light_rows.ts";
import { createSunDial } from "./sun_dial.ts";

const types: LightInfo["type"][] = ["point", "spot", "directional", "rectangle", "disk"];

export function createLightSection(viewer: Viewer): HTMLElement {
  const { parts } = viewer;
  const select = element("select", {
    name: "light",
    change: () => {
      viewer.handles.choose({ kind: "light", name: select.value });
      show();
    },
  });
  const selected = (): LightInfo | undefined =>
    parts.lights.value.find(({ name }) => name === select.value) ?? parts.lights.value[0];
  const patch = (change: LightPatch): void => {
    const light = selected();
    if (light) parts.patchLight(light.name, change as Partial<LightInfo>);
  };
  const enabled = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "light_enabled",
    "aria-label": "Light enabled",
    change: () => patch({ enabled: enabled.checked }),
  });
  const reset = button("Reset this light", "reset", () => {
    const light = selected();
    if (light) parts.resetLight(light.name);
  });
  const remove = button("Remove this light", "close", () => {
    const light = selected();
    if (light) void parts.removeLight(light.name);
  });
  const handles = element(
    "button",
    {
      type: "button",
      class: "button quiet",
      "data-tip": "Handles over the view move and turn this light",
      click: () => {
        const light = selected();
        if (light) viewer.handles.toggle({ kind: "light", name: light.name });
      },
    },
    "Handles in the view",
  );
  const dial = createSunDial("Direction of the sun", (direction) => patch({ direction }));
  const dialRow = element("div", { class: "dial-row" }, dial.node);
  const colour = element("input", {
    type: "color",
    name: "light_colour",
    "aria-label": "Colour of the light",
    input: () => patch({ color: linearColour(colour.value) }),
  });
  const rows = createLightRows(selected, patch);
  const editor = element(
    "div",
    { class: "section-body" },
    field("Light", select, enabled, reset, remove),
    element("div", { class: "tool-buttons" }, handles),
    dialRow,
    field("Colour", colour),
    ...rows.nodes,
  );
  const added = createAdder(viewer, (name) => {
    select.value = name;
    viewer.handles.choose({ kind: "light", name });
    show();
  });
  const show = (): void => {
    const light = selected();
    editor.hidden = !light;
    if (!light) return;
    select.value = light.name;
    enabled.checked = light.enabled;
    const target = { kind: "light", name: light.name } as const;
    handles.setAttribute("aria-pressed", String(viewer.handles.shows(target)));
    dialRow.hidden = light.type !== "directional";
    if (light.direction) dial.show(light.direction);
    colour.value = displayColour(light.color);
    rows.show(light);
  };
  const section = createSection({
    id: "lights",
    title: "Lights",
    body: element("div", {}, editor, added),
    openByDefault: true,
  });
  const update = (): void => {
    const adds = viewer.capabilities.has("lights.add");
    added.hidden = remove.hidden = !adds;
    section.hidden = parts.lights.value.length === 0 && !(adds && viewer.scene.value);
    const names = parts.lights.value.map(({ name }) => ({ value: name, label: name }));
    setOptions(select, names);
    show();
  };
  parts.lights.watch(update);
  viewer.scene.watch(update);
  viewer.capabilities.methods.watch(update);
  viewer.handles.target.watch(show);
  watchUnfolded(section, (unfolded) => viewer.handles.setListed("light", unfolded));
  return section;
}

/** Adds a light of a chosen type; `report` gets its name. */
function createAdder(viewer: Viewer, report: (name: string) => void): HTMLElement {
  const type = element(
    "select",
    { name: "light_type" },
    ...types.map((value) => element("option", { value }, humanise(value))),
  );
  const add = async (): Promise<void> => {
    const name = await viewer.parts.addLight({
      type: type.value as LightInfo["type"],
      patch: placeOf(type.value as LightInfo["type"], viewer),
    });
    if (name !== null) report(name);
  };
  return element(
    "div",
    { class: "section-body" },
    field("New light", type, button("Add a light", "sun", () => void add())),
  );
}

/** Between the camera and what it looks at, shining there. */
function placeOf(type: LightInfo["type"], viewer: Viewer): LightPatch {
  const camera = viewer.camera.value;
  if (!camera) return {};
  const toward = camera.target.map((value, axis) => value - (camera.eye[axis] as number));
  const position = camera.eye.map((value, axis) => value + 0.4 * (toward[axis] as number));
  const patch: LightPatch = {};
  if (type !== "directional") patch.position = position as LightPatch["position"];
  if (type !== "point") patch.direction = toward as LightPatch["direction"];
  return patch;
}
