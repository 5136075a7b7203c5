// A client in a few lines, for programs and pages that need no worker: connects, greets, hands on
// pictures and acknowledges them. Works wherever there is a WebSocket of the Web's kind: browsers,
// Node 22 and later; elsewhere the caller brings one.

import { type FrameHeader, parseFrameHeader } from "./frame_header.ts";
import {
  type Hello,
  type Methods,
  type StreamConfigureParams,
  type StreamSettings,
  subprotocol,
} from "./messages.ts";
import { type RequestArguments, RpcPeer } from "./rpc.ts";

/** A little more than the longest that a capture waits in the server. */
const longestCallMs = 310_000;
const connectMs = 30_000;

export interface ClientOptions {
  /** What the server's log calls this client. */
  client?: string;
  codecs?: string[];
  /** Where to be; left out, what the address says, or main. */
  session?: string;
  /** What a server with tokens asks for. It is in no address and in no log. */
  token?: string;
  /** How long calls wait for their answers, unless they say otherwise. */
  timeoutMs?: number;
  /**
   * Each picture as it comes, still encoded. It is acknowledged when the function has returned or
   * failed; one that takes 10 s ends the connection. Left out, the stream is paused.
   */
  frame?: (header: FrameHeader, payload: Uint8Array<ArrayBuffer>) => void | Promise<void>;
  notification?: (method: string, params: unknown) => void | Promise<void>;
  /** The connection ended, by whomever. */
  closed?: (code: number, reason: string) => void;
  /** What the functions above raised; written to the console if left out. It ends nothing. */
  error?: (error: unknown) => void;
  /** In place of the global one, for instance the class of the package ws. */
  webSocket?: typeof WebSocket;
}

export class HeliographClient {
  readonly hello: Hello;
  private readonly socket: WebSocket;
  private readonly peer: RpcPeer;
  private readonly timeoutMs: number;

  private constructor(hello: Hello, socket: WebSocket, peer: RpcPeer, timeoutMs: number) {
    this.hello = hello;
    this.socket = socket;
    this.peer = peer;
    this.timeoutMs = timeoutMs;
  }

  /**
   * @param url of the WebSocket, for example ws://127.0.0.1:8080/ws
   * @throws RpcError when the server refuses the greeting, Error when there is no server of this
   * protocol or it does not know the token
   */
  static async connect(url: string, options: ClientOptions = {}): Promise<HeliographClient> {
    const { client = "heliograph-typescript", codecs = ["jpeg"], session } = options;
    const timeoutMs = options.timeoutMs ?? longestCallMs;
    const make = options.webSocket ?? WebSocket;
    const socket = new make(url, subprotocols(options.token));
    socket.binaryType = "arraybuffer";
    const peer = new RpcPeer(
      (text) => socket.send(text),
      (method, params) => void guarded(options, () => options.notification?.(method, params)),
    );
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data === "string") peer.receive(data);
      else void guarded(options, () => take(data, peer, options));
    };
    await opened(socket, url);
    peer.open();
    socket.onclose = ({ code, reason }) => {
      peer.close();
      void guarded(options, () => options.closed?.(code, reason));
    };
    try {
      const greeting = { client, codecs, session };
      const hello = await peer.request("hello", greeting, timeoutMs);
      if (!options.frame) await peer.request("stream.pause", {}, timeoutMs);
      return new HeliographClient(hello, socket, peer, timeoutMs);
    } catch (error) {
      socket.close();
      throw error;
    }
  }

  /** Calls a method. @throws RpcError (with code 0 when no answer came in time), ChannelClosed */
  request<Name extends keyof Methods>(
    method: Name,
    ...[params, timeoutMs = this.timeoutMs]: RequestArguments<Methods[Name]["params"]>
  ): Promise<Methods[Name]["result"]> {
    const args = [params, timeoutMs] as RequestArguments<Methods[Name]["params"]>;
    return this.peer.request(method, ...args);
  }

  /** Calls a method without waiting for an answer. */
  notify<Name extends keyof Methods>(method: Name, params: Methods[Name]["params"]): void {
    this.peer.notify(method, params);
  }

  configureStream(change: StreamConfigureParams): Promise<StreamSettings> {
    return this.request("stream.configure", change);
  }

  close(): void {
    this.socket.close(1000);
  }
}

/** The token goes as a second subprotocol: browsers let pages set no header. */
function subprotocols(token: string | undefined): string[] {
  if (!token) return [subprotocol];
  const bytes = new TextEncoder().encode(token);
  const base64 = btoa(String.fromCharCode(...bytes));
  const encoded = base64.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return [subprotocol, `${subprotocol}.token.${encoded}`];
}

function opened(socket: WebSocket, url: string): Promise<void> {
  return new Promise((resolve, reject) => {
    const fail = (): void => {
      clearTimeout(timer);
      reject(new Error(`No server lets this client in and speaks ${subprotocol} at ${url}`));
    };
    const timer = setTimeout(() => {
      socket.close();
      fail();
    }, connectMs);
    socket.onopen = () => {
      clearTimeout(timer);
      resolve();
    };
    socket.onerror = fail; // not every Node tells of a refusal by onclose
    socket.onclose = fail;
  });
}

async function take(message: ArrayBuffer, peer: RpcPeer, options: ClientOptions): Promise<void> {
  const header = parseFrameHeader(message);
  try {
    await options.frame?.(header, new Uint8Array(message, header.headerBytes));
  } finally {
    peer.notify("stream.ack", { frame_seq: header.frameSeq });
  }
}

/** Runs what the caller brought; an error there is told and ends nothing. */
async function guarded(options: ClientOptions, work: () => void | Promise<void>): Promise<void> {
  try {
    await work();
  } catch (error) {
    if (options.error) options.error(error);
    else console.error(error);
  }
}
