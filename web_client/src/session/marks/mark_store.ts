// A list of what viewers have added to the scene: in the session, which all of them share. Changes
// by this page can be undone.

import type { AnimationState, SceneInfo } from "heliograph/messages.ts";
import { RpcError, type RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../../common/signal.ts";
import type { Step } from "../history/undo_history.ts";
import { followMotion } from "./moving_points.ts";

export interface MarksHost {
  rpc: RpcPeer;
  capabilities: { methods: Signal<ReadonlySet<string>>; has(method: string): boolean };
  scene: Signal<SceneInfo | null>;
  animation: Signal<AnimationState | null>;
  history: { add(step: Step): void };
  /** Whether what the page showed is still to be restored in another session. */
  isRestoring(): boolean;
  attempt(action: () => Promise<unknown>): Promise<void>;
}

/** The methods of one kind of marks. */
interface MarkCalls<Item, List, Request> {
  list(): Promise<List>;
  add(request: Request): Promise<List>;
  remove(id: number): Promise<List>;
  clear(): Promise<List>;
  /** The name of `list`. */
  method: string;
  itemsOf(list: List): Item[];
  /** Adds the same mark again. */
  requestOf(item: Item): Request;
  /** "Distance", for the history. */
  nameOf(item: Item): string;
  /** Whether a clip may move it. */
  moves(item: Item): boolean;
}

export class MarkStore<
  Item extends { id: number },
  List extends { scene: string | null },
  Request,
> {
  readonly list = new Signal<readonly Item[]>([]);
  protected readonly host: MarksHost;
  private readonly calls: MarkCalls<Item, List, Request>;
  /** That `list` belongs to. */
  private scene: string | null = null;

  constructor(host: MarksHost, calls: MarkCalls<Item, List, Request>) {
    this.host = host;
    this.calls = calls;
    const read = (): void => {
      if (host.scene.value && !host.isRestoring()) void this.read();
    };
    host.scene.watch(read);
    host.capabilities.methods.watch(read);
    followMotion(host.animation, () => this.list.value.some((item) => calls.moves(item)), read);
  }

  take(list: List): void {
    this.scene = list.scene;
    this.list.set(this.calls.itemsOf(list));
  }

  /** Of the session that the page is in now. */
  async read(): Promise<void> {
    if (this.host.capabilities.has(this.calls.method)) await this.change(() => this.calls.list());
  }

  /** Adds those that this page knows to another session that shows the same scene and has none. */
  async restore(): Promise<void> {
    const { list, scene } = this;
    const known = list.value;
    await this.read();
    if (known.length === 0 || list.value.length > 0 || scene !== this.scene) return;
    for (const item of known) await this.change(() => this.calls.add(this.calls.requestOf(item)));
  }

  async add(request: Request): Promise<void> {
    const before = this.list.value;
    if (!(await this.change(() => this.calls.add(request)))) return;
    const added = this.list.value.find(({ id }) => !before.some((one) => one.id === id));
    if (added) this.record(`${this.calls.nameOf(added)} added`, [], [added]);
  }

  /**
   * Adds several as one step of the history, `label`; gives why some were refused, by their places in
   * the list. @throws ChannelClosed
   */
  protected async addAll(requests: readonly Request[], label: string): Promise<Map<number, string>> {
    const refused = new Map<number, string>();
    const added: Item[] = [];
    try {
      for (const [index, request] of requests.entries()) {
        const before = this.list.value;
        try {
          this.take(await this.calls.add(request));
        } catch (error) {
          if (!(error instanceof RpcError)) throw error;
          refused.set(index, error.sentence);
          continue;
        }
        added.push(...this.list.value.filter(({ id }) => !before.some((one) => one.id === id)));
      }
    } finally {
      if (added.length > 0) this.record(label, [], added);
    }
    return refused;
  }

  async remove(item: Item): Promise<void> {
    if (!(await this.change(() => this.calls.remove(item.id)))) return;
    this.record(`${this.calls.nameOf(item)} removed`, [item], []);
  }

  async clear(): Promise<void> {
    const [first, ...more] = this.list.value;
    if (!first || !(await this.change(() => this.calls.clear()))) return;
    this.record(`${this.calls.nameOf(first)} and ${more.length} more removed`, [first, ...more], []);
  }

  /** Takes the list that the server answers with; false where it refuses. */
  protected async change(call: () => Promise<List>): Promise<boolean> {
    let done = false;
    await this.host.attempt(async () => {
      this.take(await call());
      done = true;
    });
    return done;
  }

  /** Undo leads from `after` to `before`; all keep their ids. It is refused where no mark changes. */
  private record(label: string, before: readonly Item[], after: readonly Item[]): void {
    const replace = async (gone: readonly Item[], back: readonly Item[]): Promise<boolean> => {
      const calls = [
        ...gone.map(({ id }) => () => this.calls.remove(id)),
        ...back.map((item) => () => this.calls.add(this.calls.requestOf(item))),
      ];
      let changed = false;
      for (const call of calls) changed = (await this.change(call)) || changed;
      return changed;
    };
    this.host.history.add({
      label,
      key: `${label} ${[...before, ...after].map(({ id }) => id).join()}`,
      ofScene: true,
      undo: () => replace(after, before),
      redo: () => replace(before, after),
    });
  }
}
