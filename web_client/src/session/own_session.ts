// A session of this page's own beside the shared one: for the view in a link, and for copies that
// the user asks for. It is created over HTTP before the page connects, so that the page never
// enters the shared session and other viewers see none of its changes.

import { ErrorCode, type Hello } from "heliograph/messages.ts";
import { RpcError } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import { type SessionAddress, type SessionOrigin, mainSession } from "../stream/session_address.ts";
import type { ViewState } from "./view_state.ts";

/** How long the session outlives its page: for a reload or a lost connection. */
const idleSeconds = 120;

/** Kept in the entry of the browser's history, so that a reload returns to the session. */
interface OwnRecord extends SessionOrigin {
  /** The shared session beside it. */
  shared: string;
}

interface Plan {
  /** What the session is to show; null: what its original shows. */
  view: ViewState | null;
  /** The session to copy; undefined: an empty one. */
  copyOf: string | undefined;
  shared: string;
}

interface OwnSessionHost {
  address: SessionAddress;
  /** The session that the page is connected to; null before it is. */
  current(): string | null;
  /** Connects again, to the session of the address or the one that `prepare` chooses. */
  reconnect(): void;
  /** Restores the view as soon as the page is connected. */
  show(view: ViewState): void;
  /** Reports why there is no session of the page's own. */
  refused(sentence: string): void;
  inform(sentence: string): void;
}

export class OwnSession {
  /** The shared session beside this page's own; null while the page is in a shared one. */
  readonly shared = new Signal<string | null>(null);
  private readonly host: OwnSessionHost;
  private record: OwnRecord | null = null;
  /** The record of before a reload, until it is known whether the session still exists. */
  private unconfirmed: OwnRecord | null = readRecord();
  private plan: Plan | null = null;
  private preparing: Promise<void> | null = null;
  private abandoned: string | null = null;

  constructor(host: OwnSessionHost) {
    this.host = host;
  }

  /** The name of the own session. */
  get name(): string | null {
    return this.record?.session ?? null;
  }

  /** Shows the view of a link in a session of this page's own. */
  openLink(view: ViewState): void {
    const linked = this.host.address.session;
    const copyOf = linked ?? (view.scene === undefined ? mainSession : undefined);
    const shared = this.record?.shared ?? linked ?? mainSession;
    this.abandon();
    this.plan = { view, copyOf, shared };
    if (this.host.current() !== null) this.host.reconnect();
  }

  /** Goes on in a copy of the shared session. */
  openCopy(): void {
    const session = this.host.current();
    if (session === null || this.record) return;
    this.plan = { view: null, copyOf: session, shared: session };
    this.host.reconnect();
  }

  /** Leaves the own session for the shared one. */
  joinShared(): void {
    const { record } = this;
    if (!record) return;
    this.host.address.session = record.shared === mainSession ? undefined : record.shared;
    this.abandon();
    history.replaceState(null, "", location.pathname + location.search);
    this.host.reconnect();
  }

  /** The own session that the page has left, once. */
  takeAbandoned(): string | null {
    const name = this.abandoned;
    this.abandoned = null;
    return name;
  }

  /** The next connection replaces the own session, which has ended; false if there is none. */
  planReplacement(view: ViewState | null): boolean {
    if (!this.record) return false;
    const { shared } = this.record;
    this.plan = { view, copyOf: view?.scene === undefined ? shared : undefined, shared };
    return true;
  }

  /** After a reconnect the session may have another name. */
  movedTo(origin: SessionOrigin): void {
    if (this.record) this.remember({ ...origin, shared: this.record.shared });
  }

  /** Call before every attempt to connect: finds the session of before a reload or creates one. */
  prepare(): Promise<void> {
    this.preparing ??= this.run().finally(() => (this.preparing = null));
    return this.preparing;
  }

  private async run(): Promise<void> {
    if (!this.plan && !this.unconfirmed) return;
    const hello = await this.host.address.fetchHello();
    if (!hello?.instance) return; // no server answers: the next attempt prepares again
    const before = this.unconfirmed;
    if (before) {
      this.unconfirmed = null;
      if (await this.exists(before, hello)) return this.enter(before);
      storeRecord(null);
      if (!this.plan) this.host.inform("Your own session has ended. This is the shared session.");
    }
    const { plan } = this;
    if (!plan) return;
    this.plan = null;
    try {
      await this.create(plan, hello.instance);
    } catch (error) {
      if (error instanceof RpcError) this.refuse(error, plan);
      else this.plan = plan; // the connection was lost
    }
  }

  private async create({ view, copyOf, shared }: Plan, instance: string): Promise<void> {
    const idle_timeout = idleSeconds;
    const created = await this.host.address
      .call(
        "session.create",
        copyOf === undefined ? { idle_timeout } : { copy_of: copyOf, idle_timeout },
      )
      .catch((error: unknown) => {
        const gone = error instanceof RpcError && error.code === ErrorCode.notFound;
        if (!gone || view?.scene === undefined) throw error;
        return this.host.address.call("session.create", { idle_timeout });
      });
    this.enter({ instance, session: created.name, shared });
    if (view && (view.scene !== undefined || created.scene !== null)) this.host.show(view);
  }

  private abandon(): void {
    this.abandoned = this.record?.session ?? null;
    this.remember(null);
  }

  private enter(record: OwnRecord): void {
    this.plan = null;
    this.host.address.session = record.session;
    this.remember(record);
  }

  /** The page stays in the shared session, which a link must not change. */
  private refuse(error: RpcError, { view }: Plan): void {
    const what = view ? "The view in the link was not applied" : "There is no copy";
    const why =
      error.code === ErrorCode.forbidden
        ? "View only: you can't change anything."
        : `The server has no room for a session of your own: ${error.sentence}.`;
    this.host.refused(`${what}. ${why}`);
  }

  private async exists(record: OwnRecord, { instance }: Partial<Hello>): Promise<boolean> {
    if (record.instance !== instance) return false;
    const { sessions } = await this.host.address.call("session.list", {});
    return sessions.some(({ name }) => name === record.session);
  }

  private remember(record: OwnRecord | null): void {
    this.record = record;
    this.shared.set(record?.shared ?? null);
    storeRecord(record);
  }
}

function readRecord(): OwnRecord | null {
  const state = history.state as { own?: OwnRecord } | null;
  return state?.own ?? null;
}

function storeRecord(record: OwnRecord | null): void {
  history.replaceState(record && { own: record }, "");
}
