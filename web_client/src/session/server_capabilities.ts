// Methods, file formats, presets and buffers of the server. The page offers nothing else.

import type { BufferInfo, PresetInfo } from "heliograph/messages.ts";
import { type OpenRpc, choicesOf } from "heliograph/openrpc.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";

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
  /** A frame of this revision may have other buffers than are listed; null: none is awaited. */
  private awaitedRev: number | null = null;
  /** Of the newest frame that was drawn. */
  private drawnRev = 0;

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

  /** The buffers of the newest frame; they depend on the scene and on settings. */
  async readBuffers(): Promise<void> {
    const { buffers } = await this.rpc.request("frame.buffers");
    const names = (list: BufferInfo[]): string => list.map(({ name }) => name).join();
    if (names(buffers) !== names(this.buffers.value)) this.buffers.set(buffers);
  }

  /** Frames of this revision of the session or a newer one may have other buffers. */
  async changedAt(rev: number): Promise<void> {
    this.awaitedRev = Math.max(rev, this.awaitedRev ?? 0);
    await this.readIfDrawn();
  }

  async frameDrawn(rev: number): Promise<void> {
    this.drawnRev = rev;
    await this.readIfDrawn();
  }

  /** Revisions of another session are not comparable. */
  reset(): void {
    this.awaitedRev = null;
    this.drawnRev = 0;
  }

  private async readIfDrawn(): Promise<void> {
    if (this.awaitedRev === null || this.drawnRev < this.awaitedRev) return;
    this.awaitedRev = null;
    await this.readBuffers();
  }
}
