// The nodes of the scene: their hierarchy, which are shown, which are selected.

import type {
  NodeInfo,
  NodeProperties,
  NodesVisibility,
  Notifications,
  SceneInfo,
} from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";
import type { UndoHistory } from "./history/undo_history.ts";
import type { NodesShown } from "./view_state.ts";

const nodesPerRequest = 10_000;

interface NodeStoreHost {
  rpc: RpcPeer;
  scene: Signal<SceneInfo | null>;
  capabilities: ServerCapabilities;
  history: UndoHistory;
  report(error: unknown): void;
}

export class NodeStore {
  /** In the order of their ids; empty until they are asked for. */
  readonly nodes = new Signal<readonly NodeInfo[]>([]);
  readonly hidden = new Signal<ReadonlySet<number>>(new Set());
  readonly isolated = new Signal<readonly number[]>([]);
  readonly selected = new Signal<readonly number[]>([]);
  /** Of the selected nodes; null without any. */
  readonly properties = new Signal<NodeProperties | null>(null);
  private readonly host: NodeStoreHost;
  private wanted = false;
  private reading = 0;

  constructor(host: NodeStoreHost) {
    this.host = host;
    host.scene.watch(() => void this.read());
    host.capabilities.methods.watch(() => void this.read());
  }

  /** From now on the nodes of every scene are read. */
  want(): void {
    if (this.wanted) return;
    this.wanted = true;
    void this.read();
  }

  setVisible(nodes: readonly number[], visible: boolean): void {
    const changed = nodes.filter((node) => this.hidden.value.has(node) === visible);
    if (changed.length === 0) return;
    const name = this.describe(changed);
    this.host.history.add({
      label: visible ? `${name} shown` : `${name} hidden`,
      key: `visible ${changed.join()} ${visible}`,
      ofScene: true,
      undo: () => this.patch(changed, !visible),
      redo: () => this.patch(changed, visible),
    });
    void this.patch(changed, visible);
  }

  /** Shows only these; none: all again. */
  isolate(nodes: readonly number[]): void {
    const before = this.isolated.value;
    this.host.history.add({
      label: nodes.length > 0 ? `${this.describe(nodes)} isolated` : "isolation ended",
      key: `isolate ${nodes.join()}`,
      ofScene: true,
      undo: () => this.sendIsolated(before),
      redo: () => this.sendIsolated(nodes),
    });
    void this.sendIsolated(nodes);
  }

  select(nodes: readonly number[]): void {
    this.takeSelection(nodes);
    void this.attempt(async () => {
      await this.host.rpc.request("selection.set", { nodes: [...nodes] });
    });
  }

  /** As far as this page knows it; undefined where all is as in the file. */
  shown(): NodesShown | undefined {
    const [hidden, isolated] = [[...this.hidden.value], [...this.isolated.value]];
    const selected = [...this.selected.value];
    const any = hidden.length + isolated.length + selected.length > 0;
    return any ? { hidden, isolated, selected } : undefined;
  }

  /** A name for several nodes as for one. */
  describe(nodes: readonly number[]): string {
    if (nodes.length !== 1) return `${nodes.length} objects`;
    return nodeName(this.nodes.value[nodes[0] as number] ?? { id: nodes[0] as number, name: "" });
  }

  /** Takes a change by another viewer. */
  notified(method: string, params: unknown): void {
    if (method === "selection.changed") {
      this.takeSelection((params as Notifications["selection.changed"]).nodes);
    } else {
      this.takeVisibility(params as Notifications["nodes.changed"]);
    }
  }

  private patch(nodes: readonly number[], visible: boolean): Promise<boolean> {
    return this.attempt(async () => {
      const request = { nodes: [...nodes], patch: { visible } };
      this.takeVisibility(await this.host.rpc.request("nodes.patch", request));
    });
  }

  private sendIsolated(nodes: readonly number[]): Promise<boolean> {
    return this.attempt(async () => {
      this.takeVisibility(await this.host.rpc.request("nodes.isolate", { nodes: [...nodes] }));
    });
  }

  private takeVisibility({ hidden, isolated }: Omit<NodesVisibility, "rev">): void {
    this.hidden.set(new Set(hidden));
    this.isolated.set(isolated);
    if (this.selected.value.length > 0) void this.readProperties();
  }

  private takeSelection(nodes: readonly number[]): void {
    this.selected.set(nodes);
    void this.readProperties();
  }

  private async readProperties(): Promise<void> {
    const nodes = this.selected.value;
    if (nodes.length === 0) {
      this.properties.set(null);
      return;
    }
    await this.attempt(async () => {
      const properties = await this.host.rpc.request("nodes.info", { nodes: [...nodes] });
      if (nodes === this.selected.value) this.properties.set(properties);
    });
  }

  private async read(): Promise<void> {
    this.reading += 1;
    if (!this.wanted || !this.host.capabilities.has("nodes.list")) return;
    const reading = this.reading;
    const isCurrent = (): boolean => reading === this.reading;
    if (!this.host.scene.value) {
      this.nodes.set([]);
      this.takeVisibility({ hidden: [], isolated: [] });
      this.takeSelection([]);
      return;
    }
    await this.attempt(async () => {
      const nodes: NodeInfo[] = [];
      for (let total = Infinity; nodes.length < total; ) {
        const part = await this.host.rpc.request("nodes.list", {
          first: nodes.length,
          count: nodesPerRequest,
        });
        if (!isCurrent()) return;
        nodes.push(...part.nodes);
        total = part.nodes.length > 0 ? part.total : 0;
        this.isolated.set(part.isolated);
      }
      this.hidden.set(new Set(nodes.filter(({ visible }) => !visible).map(({ id }) => id)));
      this.nodes.set(nodes);
      this.takeSelection((await this.host.rpc.request("selection.get")).nodes);
    });
  }

  /** Whether the server answers without an error. */
  private async attempt(action: () => Promise<void>): Promise<boolean> {
    try {
      await action();
      return true;
    } catch (error) {
      if (!(error instanceof ChannelClosed)) this.host.report(error);
      return false;
    }
  }
}

export function nodeName({ id, name }: Pick<NodeInfo, "id" | "name">): string {
  return name || `Node ${id}`;
}
