// A client for programs and pages that need no worker: connects, sends hello, delivers frames and
// acknowledges them. Needs a WebSocket class: browsers and Node 22 or later have one.

import { type FrameDepth, readFrameDepth } from "./frame_depth.ts";
import { type FrameHeader, parseFrameHeader } from "./frame_header.ts";
import {
  type Hello,
  type Methods,
  type StreamConfigureParams,
  type StreamSettings,
  subprotocol,
} from "./messages.ts";
import { type RequestArguments, RpcPeer } from "./rpc.ts";

/** A little more than the server's timeout of a capture. */
const callTimeoutMs = 310_000;
const connectTimeoutMs = 30_000;

export interface ClientOptions {
  /** Name of this client in the server's log. */
  client?: string;
  codecs?: string[];
  /** The session to join; by default the one in the URL, or main. */
  session?: string;
  /** The access token, if the server needs one. It is in no URL and in no log. */
  token?: string;
  /** Default timeout of calls. */
  timeoutMs?: number;
  /**
   * Receives each encoded frame. The frame is acknowledged when the function has returned or
   * failed; after 10 s without acknowledgement the server disconnects. If left out, the stream is
   * paused. `depth` is null unless it was requested with configureStream.
   */
  frame?: (
    header: FrameHeader,
    payload: Uint8Array<ArrayBuffer>,
    depth: FrameDepth | null,
  ) => void | Promise<void>;
  notification?: (method: string, params: unknown) => void | Promise<void>;
  /** The connection was closed, by the server or the client. */
  closed?: (code: number, reason: string) => void;
  /** Receives errors of the functions above; by default they go to the console. */
  error?: (error: unknown) => void;
  /** Replaces the global class, for example by that of the package ws. */
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
   * @throws RpcError when the server rejects hello, Error when no server of this protocol answers
   * or it rejects the token
   */
  static async connect(url: string, options: ClientOptions = {}): Promise<HeliographClient> {
    const { client = "heliograph-typescript", codecs = ["jpeg"], session } = options;
    const timeoutMs = options.timeoutMs ?? callTimeoutMs;
    const WebSocketClass = options.webSocket ?? WebSocket;
    const socket = new WebSocketClass(url, subprotocols(options.token));
    socket.binaryType = "arraybuffer";
    const peer = new RpcPeer(
      (text) => socket.send(text),
      (method, params) => void guarded(options, () => options.notification?.(method, params)),
    );
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data === "string") peer.receive(data);
      else void guarded(options, () => receiveFrame(data, peer, options));
    };
    await opened(socket, url);
    peer.open();
    socket.onclose = ({ code, reason }) => {
      peer.close();
      void guarded(options, () => options.closed?.(code, reason));
    };
    try {
      const params = { client, codecs, session };
      const hello = await peer.request("hello", params, timeoutMs);
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

/** The token is sent as a second subprotocol, since browsers do not let pages set headers. */
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
      reject(new Error(`No server of ${subprotocol} accepts this client at ${url}`));
    };
    const timer = setTimeout(() => {
      socket.close();
      fail();
    }, connectTimeoutMs);
    socket.onopen = () => {
      clearTimeout(timer);
      resolve();
    };
    socket.onerror = fail; // some versions of Node do not call onclose for a rejected upgrade
    socket.onclose = fail;
  });
}

async function receiveFrame(
  message: ArrayBuffer,
  peer: RpcPeer,
  options: ClientOptions,
): Promise<void> {
  const header = parseFrameHeader(message);
  try {
    const depth = await readFrameDepth(message, header);
    await options.frame?.(header, new Uint8Array(message, header.headerBytes), depth);
  } finally {
    peer.notify("stream.ack", { frame_seq: header.frameSeq });
  }
}

/** Runs a function of the caller and reports its errors. */
async function guarded(options: ClientOptions, work: () => void | Promise<void>): Promise<void> {
  try {
    await work();
  } catch (error) {
    if (options.error) options.error(error);
    else console.error(error);
  }
}
