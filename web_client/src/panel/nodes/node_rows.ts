// Which rows of the tree of nodes there are: what is folded or does not match a search has none.

import type { NodeInfo } from "heliograph/messages.ts";

/** One row: a node, how deep it lies, and its place among its siblings. */
export interface NodeRow {
  node: NodeInfo;
  level: number;
  place: number;
  siblings: number;
  /** null: it has no children. */
  open: boolean | null;
}

interface Hierarchy {
  roots: number[];
  children: Map<number, number[]>;
}

export function hierarchyOf(nodes: readonly NodeInfo[]): Hierarchy {
  const roots: number[] = [];
  const children = new Map<number, number[]>();
  for (const { id, parent } of nodes) {
    if (parent === null) roots.push(id);
    else if (children.has(parent)) children.get(parent)?.push(id);
    else children.set(parent, [id]);
  }
  return { roots, children };
}

/** The nodes whose names contain `text`, and all above them. */
export function matchesOf(nodes: readonly NodeInfo[], text: string): Set<number> {
  const part = text.toLowerCase();
  const found = new Set<number>();
  for (const node of nodes) {
    if (!node.name.toLowerCase().includes(part)) continue;
    for (let at: NodeInfo | undefined = node; at && !found.has(at.id); ) {
      found.add(at.id);
      at = at.parent === null ? undefined : nodes[at.parent];
    }
  }
  return found;
}

/** From the top; `only`: nodes that may have rows, which are all unfolded then. */
export function rowsOf(
  nodes: readonly NodeInfo[],
  { roots, children }: Hierarchy,
  isOpen: (id: number) => boolean,
  only: ReadonlySet<number> | null,
): NodeRow[] {
  const listed = (ids: readonly number[]): readonly number[] =>
    only ? ids.filter((id) => only.has(id)) : ids;
  const rows: NodeRow[] = [];
  const pending: { ids: readonly number[]; next: number }[] = [{ ids: listed(roots), next: 0 }];
  while (pending.length > 0) {
    const level = pending.length;
    const list = pending[level - 1] as { ids: readonly number[]; next: number };
    const id = list.ids[list.next];
    if (id === undefined) {
      pending.pop();
      continue;
    }
    list.next += 1;
    const below = listed(children.get(id) ?? []);
    const open = below.length === 0 ? null : only !== null || isOpen(id);
    const node = nodes[id] as NodeInfo;
    rows.push({ node, level, place: list.next, siblings: list.ids.length, open });
    if (open) pending.push({ ids: below, next: 0 });
  }
  return rows;
}
