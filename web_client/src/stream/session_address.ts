// Where a page's session is: what leads to its server, past a balancer too, and its name there.

import type { Hello } from "heliograph/messages.ts";

export const mainSession = "main";
const answerWithinMs = 5000;
/** Of 16 servers one is missed by so many names in one of fifty cases. */
const namesToTry = 60;

/** A session of a certain run of a server. */
export interface SessionOrigin {
  instance: string;
  session: string;
}

/**
 * What leads everyone who lost a session to one and the same server: its name, which may be tried
 * again, or for the main one, which every server has, a name that tells of the lost run.
 */
export function rendezvousRoute({ instance, session }: SessionOrigin): string {
  return session === mainSession ? `${mainSession}-${instance.slice(0, 8)}` : session;
}

export class SessionAddress {
  private readonly base: string;
  /** A balancer sends requests with the same one to the same server; null: a cookie decides. */
  route: string | null;
  /** The session to be in; undefined: the server's own. */
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

  /** An address on our server. What it does not name otherwise is about the main session. */
  address(path: string, route = this.route): URL {
    const url = new URL(path, this.base);
    if (route === null) return url;
    url.searchParams.set("session", route);
    url.searchParams.set("enter", mainSession);
    return url;
  }

  /** The page's address as it leads to this place. */
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

  /** Who answers plain HTTP there; null where nobody does. */
  async fetchHello(route = this.route): Promise<Partial<Hello> | null> {
    const patience = new AbortController();
    const timer = setTimeout(() => patience.abort(), answerWithinMs);
    try {
      const response = await fetch(this.address("rpc", route), {
        method: "POST",
        headers: { "content-type": "application/json" },
        body: JSON.stringify({ jsonrpc: "2.0", id: 1, method: "hello", params: {} }),
        signal: patience.signal,
      });
      return ((await response.json()) as { result?: Partial<Hello> }).result ?? null;
    } catch {
      return null;
    } finally {
      clearTimeout(timer);
    }
  }

  /**
   * A place from which an address leads everybody here. Every server has a main session, and who is
   * in it by a cookie needs a name that happens to lead to the same server.
   */
  async findShareable({ instance, session }: SessionOrigin): Promise<SessionAddress> {
    const known = this.route === null ? [] : [this.route];
    for (let tried = 0; tried < namesToTry; tried += 1) {
      const route = [...known, session][tried] ?? `to-${Math.random().toString(36).slice(2, 10)}`;
      const there = await this.fetchHello(route);
      if (!there || there.instance === instance) return new SessionAddress(this.base, route, session);
    }
    throw new Error("No link was found that leads others to the server that you are on");
  }
}
