// The section "Objects" of the Scene tab: the tree, a search, and what is selected.

import type { NodeProperties } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { PointPicker } from "../../view/picker.ts";
import { button, element, setText } from "../../widgets/element.ts";
import { createSection } from "../../widgets/section.ts";
import { createExplodeRow } from "./explode_row.ts";
import { createNodeTree } from "./node_tree.ts";

const maxListedMaterials = 4;

export function createNodeSection(viewer: Viewer, picker: PointPicker): HTMLElement {
  const store = viewer.nodes;
  const tree = createNodeTree(viewer);
  const search = element("input", {
    type: "search",
    name: "node_search",
    placeholder: "Search objects",
    "aria-label": "Search objects",
    input: () => tree.search(search.value),
  });
  const body = element(
    "div",
    { class: "section-body nodes" },
    search,
    tree.node,
    createSelectionView(viewer),
    createExplodeRow(viewer),
  );
  const section = createSection({
    id: "objects",
    title: "Objects",
    body,
    openByDefault: false,
  });
  const fold = section.querySelector("details") as HTMLDetailsElement;
  const update = (): void => {
    if (fold.open) store.want();
    picker.onClick(fold.open ? (x, y, event) => void pick(x, y, event) : null);
  };
  const pick = async (x: number, y: number, event: PointerEvent): Promise<void> => {
    if (!viewer.mayChange) return;
    const surface = await viewer.queries.pick(x, y);
    const node = surface?.node ?? null;
    const add = event.shiftKey || event.ctrlKey || event.metaKey;
    const before = store.selected.value;
    if (node === null) {
      if (!add && before.length > 0) store.select([]);
    } else if (!add) {
      store.select([node]);
    } else if (before.includes(node)) {
      store.select(before.filter((one) => one !== node));
    } else {
      store.select([...before, node]);
    }
  };
  fold.addEventListener("toggle", update);
  update();
  viewer.capabilities.methods.watch((methods) => (section.hidden = !methods.has("nodes.list")));
  return section;
}

/** Properties of what is selected, and what can be done with it. */
function createSelectionView(viewer: Viewer): HTMLElement {
  const store = viewer.nodes;
  const title = element("h3", {});
  const facts = element("dl", { class: "node-facts" });
  const selected = (): readonly number[] => store.selected.value;
  const anyShown = (): boolean => selected().some((node) => !store.hidden.value.has(node));
  const focus = button("Focus on the selection", "target", () => {
    void viewer.cameraMoves.fit([...selected()]);
  });
  const eye = button("Hide the selection", "eye", () => store.setVisible(selected(), !anyShown()));
  const isolate = button("Show only the selection", "isolate", () => store.isolate(selected()));
  const clear = button("Select nothing", "close", () => store.select([]));
  const all = element(
    "button",
    { type: "button", class: "button", click: () => showAll(viewer) },
    "Show everything",
  );
  const details = element(
    "div",
    { class: "node-selection" },
    element("div", { class: "node-actions" }, title, focus, eye, isolate, clear),
    facts,
  );
  const node = element("div", { role: "status", "aria-label": "Selected objects" }, details, all);
  const show = (): void => {
    const properties = store.properties.value;
    details.hidden = !properties || selected().length === 0;
    all.hidden = store.hidden.value.size === 0 && store.isolated.value.length === 0;
    if (!properties) return;
    setText(title, store.describe(selected()));
    const label = anyShown() ? "Hide the selection" : "Show the selection";
    eye.setAttribute("aria-label", label);
    eye.dataset.tip = label;
    facts.replaceChildren(
      ...describe(properties).flatMap(([name, value]) => [
        element("dt", {}, name),
        element("dd", { "data-property": name.toLowerCase() }, value),
      ]),
    );
  };
  for (const signal of [store.properties, store.hidden, store.isolated]) signal.watch(show);
  return node;
}

function showAll(viewer: Viewer): void {
  const store = viewer.nodes;
  if (store.isolated.value.length > 0) store.isolate([]);
  store.setVisible([...store.hidden.value], true);
}

function describe(properties: NodeProperties): [name: string, value: string][] {
  const { triangles, instances, bounds, materials, shown } = properties;
  const rows: [string, string][] = [
    ["Triangles", triangles.toLocaleString("en")],
    ["Meshes", instances.toLocaleString("en")],
  ];
  if (bounds) {
    const sides = bounds.max.map((value, i) => length(value - (bounds.min[i] as number)));
    rows.push(["Size", `${sides.join(" × ")} m`]);
  }
  if (materials.length > 0) {
    const more = materials.length - maxListedMaterials;
    const listed = materials.slice(0, maxListedMaterials).join(", ");
    rows.push(["Material", more > 0 ? `${listed} and ${more} more` : listed]);
  }
  if (!shown && instances > 0) rows.push(["Shown", "No"]);
  return rows;
}

function length(metres: number): string {
  return String(Number(metres.toPrecision(3)));
}
