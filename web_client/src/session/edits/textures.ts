// The textures of the scene's materials, and the uploaded images that can take their place.

import {
  type EditDocumentTextures,
  ErrorCode,
  type Methods,
  type SceneInfo,
} from "heliograph/messages.ts";
import { RpcError, type RpcPeer } from "heliograph/rpc.ts";
import { humanise } from "heliograph/settings_schema.ts";
import { Signal } from "../../common/signal.ts";
import type { UndoHistory } from "../history/undo_history.ts";

const loadTimeoutMs = 600_000;

type TextureList = Methods["textures.list"]["result"];
export type Texture = TextureList["textures"][number];
type Image = Methods["images.list"]["result"]["images"][number];
/** What a slot is to have: an image of the server, the texture of the file, or none. */
export type TextureChoice = { image: string | null } | { removed: true };

interface Loading {
  kind: "texture";
  name: string;
  stage: string;
  fraction: number;
  by: string;
}

interface TexturesHost {
  rpc: RpcPeer;
  scene: Signal<SceneInfo | null>;
  capabilities: { methods: Signal<ReadonlySet<string>>; has(method: string): boolean };
  history: UndoHistory;
  loading: {
    start(loading: Loading): void;
    takesEffect(rev: number): void;
    endTexture(): void;
  };
  report(error: unknown): void;
  /** Materials are others where textures are. */
  changed(): void;
}

export class Textures {
  readonly list = new Signal<TextureList | null>(null);
  readonly images = new Signal<Image[]>([]);
  private readonly host: TexturesHost;

  constructor(host: TexturesHost) {
    this.host = host;
    host.scene.watch(() => void this.read());
    host.capabilities.methods.watch(() => void this.read());
  }

  /** The slot of a material; nothing where it is empty in the file and unchanged. */
  find(material: string, slot: string): Texture | undefined {
    return entryOf(this.list.value?.textures ?? [], { material, slot });
  }

  /** Slots that differ from the file; undefined while they are unknown. */
  edits(): EditDocumentTextures[] | undefined {
    return this.list.value?.textures.flatMap((texture) => {
      const { material, slot, image, removed } = texture;
      return image === undefined && !removed ? [] : [{ material, slot, image: image ?? null }];
    });
  }

  /** Changes a slot, as a step of the history. Whether the server takes it. */
  choose(material: string, slot: string, choice: TextureChoice): Promise<boolean> {
    return this.host.history.during(this.chooseRecorded(material, slot, choice));
  }

  private async chooseRecorded(
    material: string,
    slot: string,
    choice: TextureChoice,
  ): Promise<boolean> {
    const before = choiceOf(this.find(material, slot));
    if (!(await this.send(material, slot, choice))) return false;
    const label = `${humanise(slot).toLowerCase()} texture of ${material}`;
    this.host.history.add({
      label,
      key: `${label} ${JSON.stringify(choice)}`,
      ofScene: true,
      undo: () => this.send(material, slot, before),
      redo: () => this.send(material, slot, choice),
    });
    return true;
  }

  /** Another viewer has changed textures: what shows them is in effect from this revision on. */
  notified({ rev }: { rev: number }): void {
    this.host.loading.takesEffect(rev);
    this.host.changed();
    void this.read();
  }

  /** The name, or one like it, that no image of the server has. */
  freeName(name: string): string {
    const names = new Set(this.images.value.map((image) => image.name));
    let free = name;
    for (let number = 2; names.has(free); ++number) free = `${name}-${number}`;
    return free;
  }

  async read(): Promise<void> {
    if (!this.host.scene.value || !this.host.capabilities.has("textures.list")) return;
    try {
      const [list, { images }] = await Promise.all([
        this.host.rpc.request("textures.list", {}),
        this.host.rpc.request("images.list", {}),
      ]);
      this.images.set(images);
      this.list.set(list);
    } catch {
      this.list.set(null); // no scene or no connection: it is read again with the next one
    }
  }

  /** Files were uploaded or deleted. What is known stays where the server does not answer. */
  async readImages(): Promise<void> {
    if (!this.host.capabilities.has("textures.list")) return;
    const answer = await this.host.rpc.request("images.list", {}).catch(() => null);
    if (answer) this.images.set(answer.images);
  }

  private async send(material: string, slot: string, choice: TextureChoice): Promise<boolean> {
    const { loading, rpc } = this.host;
    const name = `the ${humanise(slot).toLowerCase()} texture`;
    loading.start({ kind: "texture", name, stage: "loading", fraction: 0, by: "" });
    try {
      const state = await rpc.request("textures.set", { material, slot, ...choice }, loadTimeoutMs);
      loading.takesEffect(state.rev);
      this.host.changed();
      return true;
    } catch (error) {
      loading.endTexture();
      if (!isReplaced(error)) this.host.report(error);
      return false;
    } finally {
      await this.read();
    }
  }
}

/** What a later load has replaced is no error; a scene whose file is another by now is one. */
function isReplaced(error: unknown): boolean {
  if (!(error instanceof RpcError)) return false;
  return error.code === ErrorCode.conflict && error.data.path !== "scene";
}

interface Slot {
  material: string;
  slot: string;
}

/** The parameters of textures.set that lead from these textures to the file with `edits`. */
export function changesTowards(
  textures: readonly Texture[],
  edits: readonly EditDocumentTextures[],
): (Slot & TextureChoice)[] {
  const others = textures.filter((texture) => !entryOf(edits, texture));
  const choices: [Slot, TextureChoice][] = [
    ...edits.map((edit): [Slot, TextureChoice] => [
      edit,
      edit.image === null ? { removed: true } : { image: edit.image },
    ]),
    ...others.map((texture): [Slot, TextureChoice] => [texture, { image: null }]),
  ];
  return choices
    .filter(([slot, choice]) => !sameChoice(choice, choiceOf(entryOf(textures, slot))))
    .map(([{ material, slot }, choice]) => ({ material, slot, ...choice }));
}

function entryOf<Entry extends Slot>(list: readonly Entry[], at: Slot): Entry | undefined {
  return list.find(({ material, slot }) => material === at.material && slot === at.slot);
}

function sameChoice(a: TextureChoice, b: TextureChoice): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** What leads to the slot as it is. */
export function choiceOf(texture: Texture | undefined): TextureChoice {
  if (texture?.removed) return { removed: true };
  return { image: texture?.image ?? null };
}

/** What the file has in a slot, in words: "planks, 1024 × 1024". */
export function describeFileTexture(texture: Texture | undefined): string {
  if (texture?.file_image === undefined) return "none";
  const size = texture.width > 0 ? `${texture.width} × ${texture.height}` : "cannot be read";
  return texture.file_image ? `${texture.file_image}, ${size}` : size;
}
