// As much of a document as lists and buttons need. A node that is taken out or moved loses the
// focus.

type Listener = (event: { detail: number }) => void;

export class FakeNode {
  childNodes: FakeNode[] = [];
  parentNode: FakeNode | null = null;
  readonly attributes = new Map<string, string>();
  readonly classList = { toggle: (): void => {} };
  private readonly listeners: [string, Listener][] = [];

  get firstChild(): FakeNode | null {
    return this.childNodes[0] ?? null;
  }

  get nextSibling(): FakeNode | null {
    const siblings = this.parentNode?.childNodes ?? [];
    return siblings[siblings.indexOf(this) + 1] ?? null;
  }

  contains(node: FakeNode | null): boolean {
    return node === this || (node !== null && this.contains(node.parentNode));
  }

  append(...nodes: FakeNode[]): void {
    for (const node of nodes) if (typeof node === "object") this.insertBefore(node, null);
  }

  insertBefore(node: FakeNode, before: FakeNode | null): void {
    node.remove();
    node.parentNode = this;
    const at = before ? this.childNodes.indexOf(before) : this.childNodes.length;
    this.childNodes.splice(at, 0, node);
  }

  remove(): void {
    if (!this.parentNode) return;
    if (this.contains(page.activeElement)) page.activeElement = null;
    this.parentNode.childNodes = this.parentNode.childNodes.filter((node) => node !== this);
    this.parentNode = null;
  }

  replaceChildren(...nodes: FakeNode[]): void {
    for (const node of [...this.childNodes]) node.remove();
    this.append(...nodes);
  }

  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }

  addEventListener(type: string, listener: Listener): void {
    this.listeners.push([type, listener]);
  }

  dispatch(type: string, detail = 0): void {
    for (const [of, listener] of this.listeners) if (of === type) listener({ detail });
  }
}

export const page = {
  activeElement: null as FakeNode | null,
  hidden: false,
  createElement: (): FakeNode => new FakeNode(),
  createElementNS: (): FakeNode => new FakeNode(),
};
