// Edits one light of the scene: on or off, intensity, size, direction.

import type { LightInfo } from "heliograph/messages.ts";
import type { SceneParts } from "../../session/scene_parts.ts";
import { button, element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createSection } from "../../widgets/section.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";
import { createSunDial } from "./sun_dial.ts";

export function createLightSection(parts: SceneParts): HTMLElement {
  const select = element("select", { name: "light", change: () => show() });
  const selected = (): LightInfo | undefined =>
    parts.lights.value.find(({ name }) => name === select.value) ?? parts.lights.value[0];
  const patch = (change: Partial<LightInfo>): void => {
    const light = selected();
    if (light) parts.patchLight(light.name, change);
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
  const dial = createSunDial("Direction of the sun", (direction) => patch({ direction }));
  const diameter = createSliderRow(
    {
      label: "Angular diameter",
      description: "Apparent size of the light: larger lights cast softer shadows.",
      unit: "degrees",
      minimum: 0,
      maximum: 20,
      scale: "cubic",
    },
    (angular_diameter) => patch({ angular_diameter }),
  );
  const radius = createSliderRow(
    {
      label: "Radius",
      description: "Size of the light: larger lights cast softer shadows.",
      unit: "metres",
      minimum: 0,
      maximum: 2,
      scale: "cubic",
    },
    (value) => patch({ radius: value }),
  );
  const intensity = createSliderRow(
    {
      label: "Intensity",
      description: "In lux for directional lights, in candela for point and spot lights.",
      unit: "",
      minimum: 0.001,
      maximum: 200_000,
      scale: "logarithmic",
    },
    (value) => patch({ intensity: value }),
  );
  const body = element(
    "div",
    { class: "section-body" },
    field("Light", select, enabled, reset),
    element("div", { class: "dial-row" }, dial.node),
    intensity.node,
    diameter.node,
    radius.node,
  );
  const show = (): void => {
    const light = selected();
    if (!light) return;
    select.value = light.name;
    enabled.checked = light.enabled;
    dial.node.parentElement!.hidden = light.type !== "directional";
    if (light.direction) dial.show(light.direction);
    intensity.show(light.intensity);
    diameter.node.hidden = light.angular_diameter === undefined;
    diameter.show(light.angular_diameter ?? 0);
    radius.node.hidden = light.radius === undefined;
    radius.show(light.radius ?? 0);
  };
  const section = createSection({ id: "lights", title: "Lights", body, openByDefault: true });
  parts.lights.watch((lights) => {
    section.hidden = lights.length === 0;
    setOptions(
      select,
      lights.map(({ name }) => ({ value: name, label: name })),
    );
    show();
  });
  return section;
}
