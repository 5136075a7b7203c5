// The address of a session: the route that leads to its server, also through a load balancer, and
// its name there.

import type { ErrorData, Hello, Methods } from "heliograph/messages.ts";
import { RpcError } from "heliograph/rpc.ts";

export const mainSession = "main";
const helloTimeoutMs = 5000;
const callTimeoutMs = 30_000;
/** With 16 servers, this many random routes miss one of them in 2 % of cases. */
const maxRoutesTried = 60;

interface HttpAnswer<Result> {
  result?: Result;
  error?: { code: number; message: string; data?: Partial<ErrorData> };
}

/** A session on one instance of a server. */
export interface SessionOrigin {
  instance: string;
  session: string;
}

/**
 * The route that all viewers of a lost session choose, so that they meet on one server: the
 * session's name or, for the main session, which every server has, a name made from the lost
 * instance.
 */
export function rendezvousRoute({ instance, session }: SessionOrigin): string {
  return session === mainSession ? `${mainSession}-${instance.slice(0, 8)}` : session;
}

export class SessionAddress {
  private readonly base: string;
  /** A load balancer sends requests of one route to one server; null: a cookie selects it. */
  route: string | null;
  /** The session to join; undefined: the server's default. */
  session: string | undefined;

  constructor(base: string, route: string | null, session: string | undefined) {
    this.base = base;
    this.route = route;
    this.session = session;
  }

  /** `?session=ROUTE`, or `?session=ROUTE&enter=SESSION` where both differ. */
  static ofPage(base: string): SessionAddress {
    const { searchParams } = new URL(base);
    const route = searchParams.get("session") || null;
    return new SessionAddress(base, route, (searchParams.get("enter") || route) ?? undefined);
  }

  /** A URL on the session's server. Unless the path names a session, it is about the main one. */
  url(path: string, route = this.route): URL {
    const url = new URL(path, this.base);
    if (route === null) return url;
    url.searchParams.set("session", route);
    url.searchParams.set("enter", mainSession);
    return url;
  }

  /** The page's URL for this session. */
  pageUrl(page: string): URL {
    const url = new URL(page);
    url.searchParams.delete("session");
    url.searchParams.delete("enter");
    const { route, session } = this;
    if (route !== null) url.searchParams.set("session", route);
    if (session !== undefined && session !== (route ?? mainSession)) {
      url.searchParams.set(route === null ? "session" : "enter", session);
    }
    return url;
  }

  /** The server's hello over HTTP; null where no server answers. */
  async fetchHello(route = this.route): Promise<Partial<Hello> | null> {
    return this.call("hello", {}, { route, timeoutMs: helloTimeoutMs }).catch(() => null);
  }

  /**
   * Calls a method over HTTP, before there is a WebSocket.
   * @throws RpcError with the server's message; TypeError or a DOMException where none answers
   */
  async call<Name extends keyof Methods>(
    method: Name,
    params: Methods[Name]["params"],
    { route = this.route, timeoutMs = callTimeoutMs } = {},
  ): Promise<Methods[Name]["result"]> {
    const timeout = new AbortController();
    const timer = setTimeout(() => timeout.abort(), timeoutMs);
    try {
      const response = await fetch(this.url("rpc", route), {
        method: "POST",
        headers: { "content-type": "application/json" },
        body: JSON.stringify({ jsonrpc: "2.0", id: 1, method, params }),
        signal: timeout.signal,
      });
      const answer = (await response.json()) as HttpAnswer<Methods[Name]["result"]>;
      if (answer.error) {
        throw new RpcError(answer.error.code, answer.error.message, answer.error.data);
      }
      return answer.result as Methods[Name]["result"];
    } finally {
      clearTimeout(timer);
    }
  }

  /**
   * An address of this session that works for other browsers. Where a cookie selects the server, a
   * route is needed that leads to the same server: random ones are tried.
   */
  async findShareable({ instance, session }: SessionOrigin): Promise<SessionAddress> {
    const current = this.route === null ? [] : [this.route];
    for (let tried = 0; tried < maxRoutesTried; tried += 1) {
      const route = [...current, session][tried] ?? `to-${Math.random().toString(36).slice(2, 10)}`;
      const hello = await this.fetchHello(route);
      if (!hello || hello.instance === instance)
        return new SessionAddress(this.base, route, session);
    }
    throw new Error("No link leads other viewers to this server. Try again later.");
  }
}
