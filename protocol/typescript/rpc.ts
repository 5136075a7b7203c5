// JSON-RPC 2.0 over any text channel: numbered requests, notifications both ways, batches.

import type { JsonObject } from "./json.ts";
import type { ErrorData, Methods } from "./messages.ts";

/** Parameters and result of each method, by its name. */
export type MethodTable = Record<string, { params: object; result: unknown }>;

/** The parameters may be left out where none is required. */
export type RequestArguments<Params> = {} extends Params
  ? [params?: Params, timeoutMs?: number]
  : [params: Params, timeoutMs?: number];

/** The code of an error that no server sends: no answer came in time. */
export const timedOut = 0;

interface RpcErrorObject {
  code: number;
  message: string;
  data?: Partial<ErrorData>;
}

export class RpcError extends Error {
  readonly code: number;
  readonly data: Partial<ErrorData>;

  constructor(code: number, message: string, data: Partial<ErrorData> = {}) {
    super(message);
    this.code = code;
    this.data = data;
  }

  /** One sentence: the server's message and its reason, unless the message contains it. */
  get sentence(): string {
    const reason = this.data.reason;
    return reason && !this.message.includes(reason) ? `${this.message}: ${reason}` : this.message;
  }
}

/** The channel was closed before the result arrived. */
export class ChannelClosed extends Error {}

interface Pending {
  resolve: (result: never) => void;
  reject: (error: Error) => void;
  timer: ReturnType<typeof setTimeout>;
}

const defaultTimeoutMs = 30_000;

/** One end of a channel. `Table` lists the methods of the other end. */
export class RpcPeer<Table extends { [Name in keyof Table]: MethodTable[string] } = Methods> {
  private readonly send: (text: string) => void;
  private readonly onNotification: (method: string, params: unknown) => void;
  private readonly pending = new Map<number, Pending>();
  private nextId = 1;
  private connected = false;

  constructor(
    send: (text: string) => void,
    onNotification: (method: string, params: unknown) => void,
  ) {
    this.send = send;
    this.onNotification = onNotification;
  }

  /** The channel is open: requests are possible until close(). */
  open(): void {
    this.connected = true;
  }

  /** @throws RpcError (with code `timedOut` when no answer came in time), ChannelClosed */
  request<Name extends keyof Table & string>(
    method: Name,
    ...[params, timeoutMs = defaultTimeoutMs]: RequestArguments<Table[Name]["params"]>
  ): Promise<Table[Name]["result"]> {
    if (!this.connected) return Promise.reject(new ChannelClosed("There is no connection"));
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => {
        this.pending.delete(id);
        reject(
          new RpcError(timedOut, `The server did not answer ${method} in ${timeoutMs / 1000} s`),
        );
      }, timeoutMs);
      this.pending.set(id, { resolve, reject, timer });
      this.send(JSON.stringify({ jsonrpc: "2.0", id, method, params: params ?? {} }));
    });
  }

  /** Calls a method without waiting for an answer. */
  notify<Name extends keyof Table & string>(method: Name, params: Table[Name]["params"]): void {
    this.send(JSON.stringify({ jsonrpc: "2.0", method, params }));
  }

  /** Takes one text message of the channel. Ignores messages that are not JSON-RPC. */
  receive(text: string): void {
    let message: unknown;
    try {
      message = JSON.parse(text);
    } catch {
      return;
    }
    for (const entry of Array.isArray(message) ? message : [message]) {
      this.dispatch(entry as JsonObject);
    }
  }

  /** Fails all pending and later requests: the channel is closed. */
  close(): void {
    this.connected = false;
    this.failAll(() => new ChannelClosed("The connection was lost"));
  }

  private failAll(error: () => Error): void {
    const requests = [...this.pending.values()];
    this.pending.clear();
    for (const { reject, timer } of requests) {
      clearTimeout(timer);
      reject(error());
    }
  }

  private dispatch(entry: JsonObject): void {
    if (typeof entry !== "object" || entry === null) return;
    if (typeof entry.method === "string") {
      if (entry.id === undefined) this.onNotification(entry.method, entry.params ?? {});
      return;
    }
    if (entry.id === null && entry.error !== undefined) {
      // The server could not read the id: fail every pending request, so that none waits without
      // end.
      return this.failAll(() => errorOf(entry));
    }
    const request = this.pending.get(entry.id as number);
    if (!request) return;
    this.pending.delete(entry.id as number);
    clearTimeout(request.timer);
    if (entry.error !== undefined) {
      request.reject(errorOf(entry));
    } else {
      request.resolve(entry.result as never);
    }
  }
}

function errorOf(entry: JsonObject): RpcError {
  const { code, message, data } = entry.error as unknown as RpcErrorObject;
  return new RpcError(code, message, data ?? {});
}
