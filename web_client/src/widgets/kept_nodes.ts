// Lists whose nodes stay as long as what they show is listed, with the focus and an open question.

interface Entry<Item> {
  node: HTMLElement;
  /** Shows the item of this name as it is now. */
  update?(item: Item): void;
}

/** Makes the entries those of the items, in this order. Entries of known names stay. */
export function updateEntries<Item extends { name: string }, Kept extends Entry<Item>>(
  entries: Map<string, Kept>,
  items: readonly Item[],
  create: (item: Item) => Kept,
): void {
  const known = new Map(entries);
  entries.clear();
  for (const item of items) {
    const entry = known.get(item.name) ?? create(item);
    entry.update?.(item);
    entries.set(item.name, entry);
  }
}

/**
 * Makes the nodes the children of `parent`, in this order. Nodes that are in place are not
 * touched, and the one that has the focus is not moved, since it would lose it.
 */
export function showNodes(parent: HTMLElement, nodes: readonly HTMLElement[]): void {
  const shown = new Set<Node>(nodes);
  for (const child of [...parent.childNodes]) if (!shown.has(child)) child.remove();
  const focused = nodes.find((node) => node.contains(document.activeElement));
  let next = parent.firstChild;
  for (const node of nodes) {
    // What is in front of the focus and comes later goes to the end, not the focus to the front.
    while (node === focused && node.parentNode === parent && next && next !== node) {
      const passed = next;
      next = next.nextSibling;
      parent.append(passed);
    }
    if (node === next) next = next.nextSibling;
    else parent.insertBefore(node, next);
  }
}
