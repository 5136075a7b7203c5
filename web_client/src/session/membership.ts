// The session that the page is in: its viewers, who controls it, and a camera of one's own.

import type { Hello, SessionControlParams, SessionInfo } from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import { type ControlState, controlStateOf } from "./control_state.ts";

interface MembershipHost {
  rpc: RpcPeer;
  /** Tells this page's id and what its token allows; null without a connection. */
  hello(): Hello | null;
  /** The list of viewers or the size of frames has changed. */
  changed(session: SessionInfo): void;
  /** The page is in another session over the same connection. */
  moved(): Promise<void>;
  attempt(action: () => Promise<unknown>): Promise<void>;
}

export class Membership {
  /** The session and its viewers; null where the server does not tell. */
  readonly session = new Signal<SessionInfo | null>(null);
  /** Whether this page may change the session. */
  readonly controlState = new Signal<ControlState>({ kind: "may_change" });
  private readonly host: MembershipHost;

  constructor(host: MembershipHost) {
    this.host = host;
  }

  /** The name of the session. */
  get name(): string {
    return this.session.value?.name ?? "main";
  }

  get mayChange(): boolean {
    return this.controlState.value.kind === "may_change";
  }

  get mayMove(): boolean {
    return this.mayChange || this.looksAround;
  }

  /** Whether this page may measure and annotate. */
  get mayAnnotate(): boolean {
    const everyone = this.host.hello()?.annotators === "everyone" && !this.looksAround;
    return this.mayChange || everyone;
  }

  /** Whether this page is the session's only viewer. */
  get isAlone(): boolean {
    return (this.session.value?.viewers.length ?? 1) <= 1;
  }

  /** Whether the camera is this page's own. */
  get looksAround(): boolean {
    return this.controlState.value.kind === "looks_around";
  }

  /** Does nothing where the server has no sessions. */
  async read(): Promise<void> {
    try {
      this.take(await this.host.rpc.request("session.info"));
    } catch (error) {
      if (error instanceof ChannelClosed) throw error;
    }
  }

  /** All viewers get the same list; hello told which entry is this page. */
  take(session: SessionInfo): void {
    const own = this.host.hello();
    const viewers = session.viewers.map((one) => ({ ...one, you: one.viewer === own?.viewer }));
    this.session.set({ ...session, viewers });
    this.controlState.set(controlStateOf(this.session.value, own?.role));
    this.host.changed(session);
  }

  /** Takes or passes on control of the session, or changes its mode. */
  async setControl(params: SessionControlParams): Promise<void> {
    await this.host.attempt(async () => {
      this.take(await this.host.rpc.request("session.control", params));
    });
  }

  /** Goes on with a camera of one's own: the others do not see it. */
  async lookAround(): Promise<void> {
    await this.host.attempt(async () => {
      this.take((await this.host.rpc.request("session.detach")).info);
      await this.host.moved();
    });
  }

  /** Back to the camera that all share. */
  async followAgain(): Promise<void> {
    const shared = this.session.value?.follows;
    if (!shared) return;
    await this.host.attempt(async () => {
      this.take((await this.host.rpc.request("session.join", { session: shared })).info);
      await this.host.moved();
    });
  }
}
