// Selects the environment map.

import type { SceneParts } from "../../session/scene_parts.ts";
import { element, setOptions } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

const withScene = "";

export function createEnvironmentField(parts: SceneParts): HTMLElement {
  const select = element("select", {
    name: "environment",
    change: () => parts.chooseEnvironment(select.value || null),
  });
  const node = field("Environment", select);
  parts.environment.watch((state) => {
    node.hidden = !state || state.environments.length === 0;
    if (!state) return;
    setOptions(select, [
      { value: withScene, label: "Automatic" },
      ...state.environments.map(({ name }) => ({ value: name, label: name })),
    ]);
    select.value = state.current ?? withScene;
  });
  return node;
}
