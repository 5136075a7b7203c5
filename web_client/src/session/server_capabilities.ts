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
  private readonly rpc: RpcPeer;

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
  }

  /** The list of buffers depends on the scene and on settings. */
  async readBuffers(): Promise<void> {
    this.buffers.set((await this.rpc.request("frame.buffers")).buffers);
  }
}
