// The session that the page is in: its viewers, who controls it, and a camera of one's own.

import type { Hello, SessionControlParams, SessionInfo } from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import { type ControlState, controlStateOf } from "./control_state.ts";

/** A viewer whose camera this page has. */
interface Followed {
  viewer: string;
  name: string;
}

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
  /** The viewer whose camera this page's own is; null: no one's. */
  readonly following = new Signal<Followed | null>(null);
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
    if (!this.looksAround) this.unfollowed();
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

  /** Takes over the camera of another viewer wherever it goes, with a camera of one's own. */
  async follow(followed: Followed): Promise<void> {
    if (!this.looksAround) await this.lookAround();
    if (!this.looksAround) return;
    await this.host.attempt(async () => {
      await this.host.rpc.request("viewer.follow", { viewer: followed.viewer });
      this.following.set(followed);
    });
  }

  /** The camera stays where it is. */
  stopFollowing(): void {
    if (this.following.value) this.host.rpc.notify("viewer.follow", {});
    this.unfollowed();
  }

  /** The server follows no longer: this page has moved its camera, or the other viewer has left. */
  unfollowed(): void {
    if (this.following.value) this.following.set(null);
  }
}
