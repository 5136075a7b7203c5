// Who else sees the scene: besides the viewers of the session those that look around with cameras of
// their own and, seen from one of these, those that share the camera. And what they point at.

import type { Vector3 } from "heliograph/json.ts";
import type { SessionInfo, ViewerInfo } from "heliograph/messages.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { type CameraPose, targetPlaneAt } from "../../common/camera_pose.ts";
import { Signal } from "../../common/signal.ts";
import type { DrawnFrame } from "../../stream/worker_messages.ts";
import { Pointers } from "./pointers.ts";

/** The list of viewers changes several times when one joins. */
const delayMs = 200;

export interface Companion extends ViewerInfo {
  /** Whether it has a camera of its own. */
  looksAround: boolean;
}

interface CompanyHost {
  rpc: Pick<RpcPeer, "request" | "notify">;
  membership: { session: Signal<SessionInfo | null> };
  capabilities: { methods: Signal<ReadonlySet<string>>; has(method: string): boolean };
  queries: { surfaceAt(x: number, y: number): Promise<Vector3 | null> };
  camera: Signal<CameraPose | null>;
  frame: Signal<DrawnFrame | null>;
  inFrame(x: number, y: number): { x: number; y: number };
}

export class Company {
  /** The viewers of other sessions. */
  readonly elsewhere = new Signal<readonly Companion[]>([]);
  readonly pointers: Pointers;
  private readonly host: CompanyHost;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(host: CompanyHost) {
    this.host = host;
    this.pointers = new Pointers({
      send: (params) => host.rpc.notify("pointer.set", params),
      hasCompany: () => host.capabilities.has("pointer.set") && this.exists,
      surfaceAt: ({ x, y }) => host.queries.surfaceAt(x, y),
      targetPlaneAt: ({ x, y }) => {
        const [camera, frame] = [host.camera.value, host.frame.value];
        if (!camera || !frame) return null;
        return targetPlaneAt(camera, frame.width / frame.height, host.inFrame(x, y));
      },
    });
    const schedule = (): void => {
      this.timer ??= setTimeout(() => {
        this.timer = undefined;
        void this.read();
      }, delayMs);
    };
    host.membership.session.watch(schedule);
    host.capabilities.methods.watch(schedule);
  }

  /** Asks who is there now. Reports no errors. */
  async read(): Promise<void> {
    const { rpc, membership, capabilities } = this.host;
    if (!membership.session.value || !capabilities.has("session.list")) return;
    try {
      const { sessions } = await rpc.request("session.list");
      const own = membership.session.value;
      const found = own ? companionsOf(own, sessions) : [];
      const changed = JSON.stringify(found) !== JSON.stringify(this.elsewhere.value);
      if (changed) this.elsewhere.set(found);
    } catch {
      // The connection was lost: the next one asks again.
    }
  }

  private get exists(): boolean {
    const here = this.host.membership.session.value?.viewers.length ?? 0;
    return here > 1 || this.elsewhere.value.length > 0;
  }
}

function companionsOf(own: SessionInfo, sessions: readonly SessionInfo[]): Companion[] {
  const leader = own.follows ?? own.name;
  return sessions
    .filter(({ name, follows }) => name !== own.name && (name === leader || follows === leader))
    .flatMap(({ viewers, follows }) =>
      viewers.map((one) => ({ ...one, looksAround: follows !== undefined })),
    );
}
