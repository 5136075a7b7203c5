// Methods, file formats, presets and buffers of the server. The page offers nothing else.

import type { BufferInfo, PresetInfo } from "heliograph/messages.ts";
import { type OpenRpc, choicesOf } from "heliograph/openrpc.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";

/** So many frames of older settings may still arrive after a change. */
const framesOnTheWay = 3;

// A static view may send fewer frames than that.
const lateReadMs = 3000;

export class ServerCapabilities {
  readonly buffers = new Signal<BufferInfo[]>([]);
  /** File formats of `frame.capture`. */
  readonly captureFormats = new Signal<ReadonlySet<string>>(new Set(["png"]));
  readonly presets = new Signal<PresetInfo[]>([]);
  /** Names of the server's methods. */
  readonly methods = new Signal<ReadonlySet<string>>(new Set());
  /** Whether the server renders jobs. */
  jobs = false;
  private readonly rpc: RpcPeer;
  /** Frames to draw before the list of buffers is read again; null: it is up to date. */
  private framesUntilRead: number | null = null;
  private lateRead: ReturnType<typeof setTimeout> | undefined;

  constructor(rpc: RpcPeer) {
    this.rpc = rpc;
  }

  has(method: string): boolean {
    return this.methods.value.has(method);
  }

  async read(): Promise<void> {
    const [document, { presets }] = await Promise.all([
      this.rpc.request("rpc.discover"),
      this.rpc.request("settings.presets"),
    ]);
    const openrpc = document as unknown as OpenRpc;
    this.methods.set(new Set(openrpc.methods.map(({ name }) => name)));
    this.captureFormats.set(new Set(choicesOf(openrpc, "frame.capture", "format")));
    this.presets.set(presets);
    // A server without jobs refuses to list them.
    const list = this.has("job.list") && this.rpc.request("job.list", { limit: 1 });
    this.jobs = list !== false && (await list.then(() => true).catch(() => false));
  }

  /** The list of buffers depends on the scene and on settings. */
  async readBuffers(): Promise<void> {
    this.framesUntilRead = null;
    const { buffers } = await this.rpc.request("frame.buffers");
    const names = (list: BufferInfo[]): string => list.map(({ name }) => name).join();
    if (names(buffers) !== names(this.buffers.value)) this.buffers.set(buffers);
  }

  /** Frames with these settings may have other buffers. */
  settingsChanged(): void {
    this.framesUntilRead = framesOnTheWay;
    clearTimeout(this.lateRead);
    this.lateRead = setTimeout(() => {
      if (this.framesUntilRead !== null) void this.readBuffers().catch(() => undefined);
    }, lateReadMs);
  }

  async frameDrawn(): Promise<void> {
    if (this.framesUntilRead === null) return;
    this.framesUntilRead -= 1;
    if (this.framesUntilRead <= 0) await this.readBuffers();
  }
}
