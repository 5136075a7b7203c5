// Planes that cut the scene open: along the axes or facing the camera; each can be moved, here or
// by handles in the view, flipped, switched off and removed.

import type { Vector3 } from "heliograph/json.ts";
import type { SectionPlane } from "heliograph/messages.ts";
import { length, normalize, subtract } from "../../common/vector.ts";
import { maxPlanes, planeName, planeRange } from "../../session/section_store.ts";
import type { Viewer } from "../../session/viewer.ts";
import { button, element } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createSection, watchUnfolded } from "../../widgets/section.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";

interface PlaneRow {
  node: HTMLElement;
  /** Whether it can show this plane: its slider has the range of one normal. */
  fits(plane: SectionPlane): boolean;
  show(plane: SectionPlane): void;
}

export function createPlanesSection(viewer: Viewer): HTMLElement {
  const { section: store } = viewer;
  let rows: PlaneRow[] = [];
  const list = element("div", { role: "group", "aria-label": "Section planes" });
  const adders = createAdders(viewer);
  const section = createSection({
    id: "section_planes",
    title: "Section planes",
    body: element("div", { class: "section-body" }, list, field("Cut along", adders)),
    openByDefault: false,
  });
  const show = (): void => {
    const planes = store.planes.value;
    const same = planes.length === rows.length && planes.every((one, i) => rows[i]?.fits(one));
    if (!same) {
      rows = planes.map((plane, index) => createPlaneRow(viewer, plane.normal, index));
      list.replaceChildren(...rows.map(({ node }) => node));
    }
    planes.forEach((plane, index) => rows[index]?.show(plane));
    for (const one of adders.querySelectorAll("button")) one.disabled = planes.length >= maxPlanes;
  };
  const update = (): void => {
    section.hidden = !viewer.scene.value || !store.supported;
  };
  store.planes.watch(show);
  viewer.scene.watch(() => {
    rows = [];
    show();
    update();
  });
  viewer.capabilities.methods.watch(update);
  viewer.handles.target.watch(show);
  watchUnfolded(section, (unfolded) => viewer.handles.setListed("plane", unfolded));
  return section;
}

/** Buttons that add a plane. */
function createAdders(viewer: Viewer): HTMLElement {
  const adder = (label: string, tip: string, normal: () => Vector3 | null): HTMLButtonElement => {
    const add = (): void => {
      const direction = normal();
      if (!direction) return;
      viewer.section.add(direction, label);
      viewer.handles.choose({ kind: "plane", index: viewer.section.planes.value.length - 1 });
    };
    return element(
      "button",
      { type: "button", class: "button quiet", "data-tip": tip, "aria-label": tip, click: add },
      label,
    );
  };
  const towardsCamera = (): Vector3 | null => {
    const camera = viewer.camera.value;
    return camera ? normalize(subtract(camera.eye, camera.target)) : null;
  };
  return element(
    "div",
    { class: "tool-buttons", role: "group", "aria-label": "Add a section plane" },
    adder("X", "Cut along X", () => [1, 0, 0]),
    adder("Y", "Cut along Y", () => [0, 1, 0]),
    adder("Z", "Cut along Z", () => [0, 0, 1]),
    adder("View", "Cut across the View", towardsCamera),
  );
}

function createPlaneRow(viewer: Viewer, normal: Vector3, index: number): PlaneRow {
  const { section: store } = viewer;
  const { least, most } = planeRange(normal, viewer.scene.value);
  const name = `Plane ${index + 1}: ${planeName(normal)}`;
  const enabled = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: `section_plane_${index + 1}`,
    change: () => store.patch(index, { enabled: enabled.checked }, "section plane switched"),
  });
  const target = { kind: "plane", index } as const;
  const handles = button(`Handles of plane ${index + 1}`, "target", () =>
    viewer.handles.toggle(target),
  );
  const flip = button(`Flip plane ${index + 1}`, "split", () => store.flip(index));
  const remove = button(`Remove plane ${index + 1}`, "close", () => {
    viewer.handles.planeRemoved(index);
    store.remove(index);
  });
  const slider = createSliderRow(
    {
      label: `Position ${index + 1}`,
      description: "What lies beyond the plane is cut away.",
      unit: "metres",
      minimum: least,
      maximum: most,
      scale: "linear",
    },
    (offset) => store.patch(index, { offset }, "section plane moved"),
  );
  return {
    node: element("div", {}, field(name, enabled, handles, flip, remove), slider.node),
    fits: (plane) => length(subtract(plane.normal, normal)) < 1e-4,
    show: (plane) => {
      enabled.checked = plane.enabled !== false;
      slider.show(plane.offset);
      handles.setAttribute("aria-pressed", String(viewer.handles.shows(target)));
    },
  };
}
