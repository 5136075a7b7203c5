// A client in a few lines, for programs and pages that need no worker: connects, greets, hands on
// pictures and acknowledges them. Works wherever there is a WebSocket: browsers, Node 22 and later.

import { type FrameHeader, parseFrameHeader } from "./frame_header.ts";
import { type Hello, type StreamSettings, subprotocol } from "./messages.ts";
import { RpcPeer } from "./rpc.ts";

export interface ClientOptions {
  /** What the server's log calls this client. */
  client?: string;
  codecs?: string[];
  session?: string;
  /** Each picture as it comes, still encoded. It is acknowledged when the function has returned. */
  frame?: (header: FrameHeader, payload: Uint8Array<ArrayBuffer>) => void | Promise<void>;
  notification?: (method: string, params: unknown) => void;
  /** The connection ended, by whomever. */
  closed?: (code: number, reason: string) => void;
}

export class HeliographClient {
  readonly hello: Hello;
  private readonly socket: WebSocket;
  private readonly peer: RpcPeer;

  private constructor(hello: Hello, socket: WebSocket, peer: RpcPeer) {
    this.hello = hello;
    this.socket = socket;
    this.peer = peer;
  }

  /**
   * @param url of the WebSocket, for example ws://127.0.0.1:8080/ws
   * @throws RpcError when the server refuses the greeting, Error when there is no server of this
   * protocol
   */
  static async connect(url: string, options: ClientOptions = {}): Promise<HeliographClient> {
    const socket = new WebSocket(url, subprotocol);
    socket.binaryType = "arraybuffer";
    const peer = new RpcPeer((text) => socket.send(text), options.notification ?? (() => {}));
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data === "string") peer.receive(data);
      else void take(data, peer, options);
    };
    await new Promise<void>((resolve, reject) => {
      socket.onopen = () => resolve();
      socket.onclose = () => reject(new Error(`No server speaks ${subprotocol} at ${url}`));
    });
    peer.open();
    socket.onclose = ({ code, reason }) => {
      peer.close();
      options.closed?.(code, reason);
    };
    try {
      const { client = "heliograph-typescript", codecs = ["jpeg"], session } = options;
      const hello = await peer.request<Hello>("hello", { client, codecs, session });
      return new HeliographClient(hello, socket, peer);
    } catch (error) {
      socket.close();
      throw error;
    }
  }

  /** Asks one method. @throws RpcError, ChannelClosed */
  request<Result>(method: string, params: object = {}): Promise<Result> {
    return this.peer.request<Result>(method, params);
  }

  /** Tells without waiting for an answer. */
  notify(method: string, params: object): void {
    this.peer.notify(method, params);
  }

  configureStream(change: Partial<StreamSettings>): Promise<StreamSettings> {
    return this.request("stream.configure", change);
  }

  close(): void {
    this.socket.close(1000);
  }
}

async function take(message: ArrayBuffer, peer: RpcPeer, options: ClientOptions): Promise<void> {
  const header = parseFrameHeader(message);
  await options.frame?.(header, new Uint8Array(message, header.headerBytes));
  peer.notify("stream.ack", { frame_seq: header.frameSeq });
}
