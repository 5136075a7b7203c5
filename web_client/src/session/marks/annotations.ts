// Texts that viewers have pinned to surfaces of the scene.

import type {
  Annotation,
  AnnotationList,
  AnnotationsAddParams,
  Snap,
} from "heliograph/messages.ts";
import { Signal } from "../../common/signal.ts";
import { type ImportResult, isSameAnnotation } from "./annotation_file.ts";
import { MarkStore, type MarksHost } from "./mark_store.ts";

export class Annotations extends MarkStore<Annotation, AnnotationList, AnnotationsAddParams> {
  /** Where the one that is being written will be pinned. */
  readonly draft = new Signal<Snap | null>(null);
  /** Ids of those that the frame shows behind other surfaces. */
  readonly hidden = new Signal<ReadonlySet<number>>(new Set());
  private asking = false;

  constructor(host: MarksHost) {
    const { rpc } = host;
    super(host, {
      method: "annotations.list",
      list: () => rpc.request("annotations.list"),
      add: (request) => rpc.request("annotations.add", request),
      remove: (id) => rpc.request("annotations.remove", { id }),
      clear: () => rpc.request("annotations.clear"),
      itemsOf: ({ annotations }) => annotations,
      requestOf: ({ id, text, author, surface }) => ({ id, text, author, surface }),
      nameOf: () => "annotation",
      moves: () => true,
    });
  }

  async edit({ id, text: before }: Annotation, text: string): Promise<void> {
    if (text === "" || text === before) return;
    const send = (to: string): Promise<boolean> =>
      this.change(() => this.host.rpc.request("annotations.edit", { id, text: to }));
    if (!(await send(text))) return;
    this.host.history.add({
      label: "annotation edited",
      key: `annotation ${id} ${text}`,
      ofScene: true,
      undo: () => send(before),
      redo: () => send(text),
    });
  }

  /** Adds those of a file that are not there yet, as one step of the history. @throws ChannelClosed */
  async import(entries: readonly AnnotationsAddParams[]): Promise<ImportResult> {
    const before = this.list.value;
    const numbered = entries.map((request, index) => ({ request, entry: index + 1 }));
    const fresh = numbered.filter(
      ({ request }) => !before.some((one) => isSameAnnotation(one, request)),
    );
    const refusals = await this.addAll(
      fresh.map(({ request }) => request),
      "annotations imported",
    );
    const refused = [...refusals].map(([at, reason]) => ({ entry: fresh[at]?.entry ?? 0, reason }));
    const known = entries.length - fresh.length;
    return { added: fresh.length - refused.length, known, refused };
  }

  /** Asks which are hidden in the newest frame; not while the last answer is awaited. */
  async readHidden(): Promise<void> {
    if (this.asking || this.list.value.length === 0) return;
    this.asking = true;
    try {
      const { hidden } = await this.host.rpc.request("annotations.hidden");
      this.hidden.set(new Set(hidden));
    } catch {
      // Where the frame has no surfaces, as a path traced one, nothing is known to be hidden.
      this.hidden.set(new Set());
    } finally {
      this.asking = false;
    }
  }
}
