// The lens: its focal length, and a point to focus on.

import type { Viewer } from "../../session/viewer.ts";
import { dot, normalize, subtract } from "../../common/vector.ts";
import type { PointPicker } from "../../view/picker.ts";
import { element } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

const sensorSetting = "lens.sensor_height";
const lensGroup = "lens";

/** In mm, of a camera whose sensor is so high; `fieldOfView` in degrees. */
export function focalLength(sensorHeight: number, fieldOfView: number): number {
  return sensorHeight / (2 * Math.tan((fieldOfView * Math.PI) / 360));
}

/** In degrees; the other way round. */
export function fieldOfView(sensorHeight: number, length: number): number {
  return (360 / Math.PI) * Math.atan(sensorHeight / (2 * length));
}

export function createLensFields(viewer: Viewer, picker: PointPicker): HTMLElement {
  const sensorHeight = (): number => Number(viewer.settings.value(sensorSetting) ?? 24);
  const length = element("input", {
    type: "text",
    name: "focal_length",
    inputmode: "decimal",
    change: () => {
      const camera = viewer.camera.value;
      const millimetres = parseFloat(length.value);
      if (!camera || !viewer.membership.mayMove || !(millimetres > 0)) {
        show();
        return;
      }
      const angle = Math.min(170, Math.max(1, fieldOfView(sensorHeight(), millimetres)));
      viewer.cameraMoves.moveTo({ ...camera, vertical_fov: angle, name: null });
    },
  });
  const show = (): void => {
    const camera = viewer.camera.value;
    length.disabled = !camera;
    if (document.activeElement === length) return;
    length.value = camera
      ? `${Number(focalLength(sensorHeight(), camera.vertical_fov).toPrecision(3))} mm`
      : "";
  };
  viewer.camera.watch(show);
  viewer.settings.tree.watch(show);
  const focus = element("div", { class: "tool-buttons" }, focusButton(viewer, picker));
  const node = field("Focal length", length, focus);
  const update = (): void => {
    const known = viewer.settings.schema.value.groups.some(({ path }) => path === lensGroup);
    node.hidden = !known || !viewer.scene.value;
  };
  viewer.settings.schema.watch(update);
  viewer.scene.watch(update);
  return node;
}

/** Focuses on the surface that is clicked next, with depth of field. */
function focusButton(viewer: Viewer, picker: PointPicker): HTMLElement {
  const button = element(
    "button",
    {
      type: "button",
      class: "button quiet",
      "data-tip": "Blur what is nearer or farther than the point that you click",
      click: () => choose(button.getAttribute("aria-pressed") !== "true"),
    },
    "Focus",
  );
  const choose = (on: boolean): void => {
    button.setAttribute("aria-pressed", String(on));
    picker.onClick(on ? (x, y, event) => void focus(x, y, event) : null);
  };
  const focus = async (x: number, y: number, event: PointerEvent): Promise<void> => {
    event.preventDefault();
    choose(false);
    const picked = await viewer.queries.pick(x, y);
    const camera = viewer.camera.value;
    if (!picked?.position || !camera) return;
    const forward = normalize(subtract(camera.target, camera.eye));
    const distance = dot(subtract(picked.position, camera.eye), forward);
    viewer.settings.apply({ lens: { depth_of_field: true, focus_distance: distance } });
  };
  choose(false);
  return button;
}
