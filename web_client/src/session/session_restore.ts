// Restores this page's view after a reconnect to another server instance: a restarted server or
// another node. The server selects the session (see `hello` in the protocol).

import type { Hello } from "heliograph/messages.ts";
import { type SessionOrigin, mainSession } from "../stream/session_address.ts";
import type { ViewState } from "./view_state.ts";

interface SessionRestoreHost {
  /** The session before the reconnect; null on the first connection. */
  origin(): SessionOrigin | null;
  mayChange(): boolean;
  /** What the page shows; null while it shows no scene. */
  viewState(): ViewState | null;
  /** The session shows something unknown. */
  clearScene(): void;
  /** The page follows this session from now on. */
  arrivedAt(origin: SessionOrigin, instanceChanged: boolean): void;
  inform(sentence: string): void;
}

export class SessionRestore {
  private readonly host: SessionRestoreHost;
  /** The session where this page has started to restore its state, also after a lost connection. */
  private restoringAt: string | null = null;

  constructor(host: SessionRestoreHost) {
    this.host = host;
  }

  /** The state to restore in the session of `hello`, given the state that was pending before. */
  pendingStateFor(hello: Hello, pending: ViewState | null): ViewState | null {
    const origin = this.host.origin();
    if (!origin || origin.instance === hello.instance) return pending;
    // A server without `restore_state` has a single session.
    const restores =
      hello.restore_state ?? (hello.restore_state === undefined && this.host.mayChange());
    if (restores) this.restoringAt = keyOf(hello);
    this.host.inform(describeReconnect(hello, origin, this.isRestoring(hello)));
    if (this.isRestoring(hello)) return pending ?? this.host.viewState();
    this.host.clearScene();
    return null;
  }

  /** The page shows what this session shows: reconnects return to it. */
  arrived({ instance, session }: Hello): void {
    const previous = this.host.origin();
    const instanceChanged = previous !== null && previous.instance !== instance;
    this.host.arrivedAt({ instance, session }, instanceChanged);
  }

  /** Whether the session was created for the state that this page restores. */
  ownsSession(hello: Hello): boolean {
    return hello.session !== mainSession && this.isRestoring(hello);
  }

  private isRestoring(hello: Hello): boolean {
    return this.restoringAt === keyOf(hello);
  }
}

function keyOf({ instance, session }: Hello): string {
  return `${instance} ${session}`;
}

function describeReconnect(
  { restore_state, role, session }: Hello,
  from: SessionOrigin,
  restores: boolean,
): string {
  if (restores && session === from.session) return "The server restarted. Your view was restored.";
  if (restores) return `Connected to another server. Your view continues in session ${session}.`;
  if (role === "view") return `Connected to another server, session ${session}.`;
  return restore_state === null || restore_state === undefined
    ? `Connected to another server, which has no free session. This is session ${session}.`
    : `Connected to another server. All viewers of your session continue in session ${session}.`;
}
