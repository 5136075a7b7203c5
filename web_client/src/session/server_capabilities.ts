// What this server can do; what it lacks is not offered.

import type { BufferInfo, PresetInfo } from "heliograph/messages.ts";
import { type OpenRpc, choicesOf } from "heliograph/openrpc.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";

export class ServerCapabilities {
  readonly buffers = new Signal<BufferInfo[]>([]);
  /** File formats of `frame.capture`. */
  readonly captureFormats = new Signal<ReadonlySet<string>>(new Set(["png"]));
  readonly presets = new Signal<PresetInfo[]>([]);
  /** Names of the methods that the server has. */
  readonly methods = new Signal<ReadonlySet<string>>(new Set());
  private readonly rpc: RpcPeer;

  constructor(rpc: RpcPeer) {
    this.rpc = rpc;
  }

  has(method: string): boolean {
    return this.methods.value.has(method);
  }

  async read(): Promise<void> {
    const [openrpc, answer] = await Promise.all([
      this.rpc.request<OpenRpc>("rpc.discover"),
      this.rpc.request<{ presets: PresetInfo[] }>("settings.presets"),
    ]);
    this.methods.set(new Set(openrpc.methods.map(({ name }) => name)));
    this.captureFormats.set(new Set(choicesOf(openrpc, "frame.capture", "format")));
    this.presets.set(answer.presets);
  }

  /** Which buffers there are depends on the scene and on settings. */
  async readBuffers(): Promise<void> {
    const answer = await this.rpc.request<{ buffers: BufferInfo[] }>("frame.buffers");
    this.buffers.set(answer.buffers);
  }
}
