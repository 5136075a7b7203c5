// The tree of nodes: only the rows in view exist as elements, however many nodes there are. Keys as
// in the ARIA authoring practices for trees; the tree itself has the focus.

import type { Viewer } from "../../session/viewer.ts";
import { nodeName } from "../../session/node_store.ts";
import { element, icon, uniqueId } from "../../widgets/element.ts";
import { isDisabled } from "../../widgets/requires_control.ts";
import { type NodeRow, hierarchyOf, matchesOf, rowsOf } from "./node_rows.ts";

const rowHeight = 26;
const rowsBeyond = 6; // on each side of those in view
const openUpTo = 60; // scenes with more nodes begin folded

interface NodeTree {
  node: HTMLElement;
  /** Shows nodes whose names contain this; empty: all. */
  search(text: string): void;
}

export function createNodeTree(viewer: Viewer): NodeTree {
  const store = viewer.nodes;
  const prefix = uniqueId("node");
  const content = element("div", { class: "node-rows", role: "presentation" });
  const tree = element(
    "div",
    {
      class: "node-tree",
      role: "tree",
      tabindex: "0",
      "aria-label": "Objects of the scene",
      "aria-multiselectable": "true",
      scroll: () => draw(),
      keydown: (event: KeyboardEvent) => press(event),
    },
    content,
  );
  let hierarchy = hierarchyOf([]);
  let rows: NodeRow[] = [];
  let toggled = new Set<number>(); // nodes that are not as they begin
  let text = "";
  let active = 0; // row with the cursor
  let anchor = 0; // where a range begins
  let selected: ReadonlySet<number> = new Set();

  const isOpen = (id: number): boolean =>
    toggled.has(id) !== store.nodes.value.length <= openUpTo;
  const list = (): void => {
    const nodes = store.nodes.value;
    rows = rowsOf(nodes, hierarchy, isOpen, text ? matchesOf(nodes, text) : null);
    active = Math.max(0, Math.min(active, rows.length - 1));
    content.style.height = `${rows.length * rowHeight}px`;
    draw();
  };
  const draw = (): void => {
    const first = Math.max(0, Math.floor(tree.scrollTop / rowHeight) - rowsBeyond);
    const last = Math.ceil((tree.scrollTop + tree.clientHeight) / rowHeight) + rowsBeyond;
    content.replaceChildren(...rows.slice(first, last).map((row, i) => createRow(row, first + i)));
    const shown = active >= first && active < last && rows.length > 0;
    if (shown) tree.setAttribute("aria-activedescendant", `${prefix}-${active}`);
    else tree.removeAttribute("aria-activedescendant");
  };
  const createRow = (row: NodeRow, index: number): HTMLElement => {
    const { id } = row.node;
    const name = nodeName(row.node);
    const hidden = store.hidden.value.has(id);
    const label = hidden ? `Show ${name}` : `Hide ${name}`;
    const fold = element("span", { class: "node-fold", click: () => unfold(index) });
    if (row.open !== null) fold.append(icon("chevron"));
    const item = element(
      "div",
      {
        class: `node-row${hidden ? " hidden-node" : ""}${index === active ? " active" : ""}`,
        id: `${prefix}-${index}`,
        role: "treeitem",
        "aria-level": String(row.level),
        "aria-posinset": String(row.place),
        "aria-setsize": String(row.siblings),
        "aria-selected": String(selected.has(id)),
        "aria-expanded": row.open === null ? undefined : String(row.open),
        "aria-label": hidden ? `${name}, hidden` : name,
        click: (event: MouseEvent) => {
          if (event.target instanceof Element && event.target.closest(".node-fold, button")) return;
          active = index;
          choose(event.ctrlKey || event.metaKey, event.shiftKey);
        },
      },
      fold,
      element("span", { class: "node-name" }, name),
      element(
        "button",
        {
          type: "button",
          class: "node-eye",
          tabindex: "-1",
          "aria-label": label,
          click: () => store.setVisible([id], hidden),
        },
        icon(hidden ? "hidden" : "eye"),
      ),
    );
    item.style.top = `${index * rowHeight}px`;
    item.style.paddingLeft = `${Math.min(row.level - 1, 12) * 12}px`;
    return item;
  };
  const unfold = (index: number): void => {
    const row = rows[index];
    if (!row || row.open === null || text) return;
    if (!toggled.delete(row.node.id)) toggled.add(row.node.id);
    list();
  };
  /** Selects the row with the cursor: alone, beside others, or all from the last one to it. */
  const choose = (add: boolean, range: boolean): void => {
    const row = rows[active];
    if (!row || isDisabled(tree)) return;
    const { id } = row.node;
    if (range) {
      const [from, to] = [Math.min(anchor, active), Math.max(anchor, active)];
      store.select(rows.slice(from, to + 1).map(({ node }) => node.id));
      return;
    }
    anchor = active;
    const others = store.selected.value.filter((one) => one !== id);
    if (add) store.select(selected.has(id) ? others : [...others, id]);
    else store.select([id]);
  };
  const moveTo = (index: number): void => {
    active = Math.max(0, Math.min(index, rows.length - 1));
    const top = active * rowHeight;
    if (top < tree.scrollTop) tree.scrollTop = top;
    const bottom = top + rowHeight - tree.clientHeight;
    if (bottom > tree.scrollTop) tree.scrollTop = bottom;
    draw();
  };
  const parentOf = (index: number): number => {
    const level = rows[index]?.level ?? 1;
    for (let i = index - 1; i >= 0; i -= 1) {
      if ((rows[i] as NodeRow).level < level) return i;
    }
    return index;
  };
  const press = (event: KeyboardEvent): void => {
    const row = rows[active];
    if (!row || event.altKey) return;
    const page = Math.max(1, Math.floor(tree.clientHeight / rowHeight) - 1);
    const moves: Record<string, number> = {
      ArrowDown: active + 1,
      ArrowUp: active - 1,
      PageDown: active + page,
      PageUp: active - page,
      Home: 0,
      End: rows.length - 1,
    };
    const target = moves[event.key];
    if (target !== undefined) {
      moveTo(target);
      if (event.shiftKey) choose(false, true);
    } else if (event.key === "ArrowRight") {
      if (row.open === false) unfold(active);
      else if (row.open) moveTo(active + 1);
    } else if (event.key === "ArrowLeft") {
      if (row.open && !text) unfold(active);
      else moveTo(parentOf(active));
    } else if (event.key === " " || event.key === "Enter") {
      choose(event.ctrlKey || event.metaKey, event.shiftKey);
    } else if (event.key === "v" || event.key === "V") {
      if (!isDisabled(tree)) {
        store.setVisible([row.node.id], store.hidden.value.has(row.node.id));
      }
    } else return;
    event.preventDefault();
    event.stopPropagation();
  };
  /** Unfolds what is above a node, and brings its row into view. */
  const reveal = (id: number): void => {
    for (let at = store.nodes.value[id]?.parent ?? null; at !== null; ) {
      if (!isOpen(at) && !toggled.delete(at)) toggled.add(at);
      at = store.nodes.value[at]?.parent ?? null;
    }
    list();
    const index = rows.findIndex(({ node }) => node.id === id);
    if (index >= 0) moveTo(index);
  };
  store.nodes.watch((nodes) => {
    hierarchy = hierarchyOf(nodes);
    toggled = new Set();
    list();
  });
  store.hidden.watch(draw);
  store.selected.watch((ids) => {
    selected = new Set(ids);
    const last = ids.at(-1);
    const isCurrent = last !== undefined && rows[active]?.node.id === last;
    if (ids.length === 1 && last !== undefined && !isCurrent) reveal(last);
    else draw();
  });
  new ResizeObserver(draw).observe(tree);
  return {
    node: tree,
    search(next) {
      text = next.trim();
      active = 0;
      list();
    },
  };
}
