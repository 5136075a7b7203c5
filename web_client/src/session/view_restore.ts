// The view state that is still to be restored in the session; it survives lost connections.

import type { Hello } from "heliograph/messages.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { Signal } from "../common/signal.ts";
import type { ControlState } from "./control_state.ts";
import { describeControl } from "./control_state.ts";
import type { FileError } from "./file_errors.ts";
import { type RestoreHost, restoreView } from "./restore_view.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";
import type { SettingsStore } from "./settings_store.ts";
import type { ViewState } from "./view_state.ts";

interface ViewRestoreHost {
  rpc: RpcPeer;
  settings: SettingsStore;
  capabilities: ServerCapabilities;
  controlState: Signal<ControlState>;
  /** From the arrival of the server's hello until the connection is lost. */
  hello(): Hello | null;
  ownsSession(hello: Hello): boolean;
  /** Before the first call. */
  begins(): void;
  /** The state is in effect: what the page shows of the session is to be read again. */
  arrived(hello: Hello): Promise<void>;
  reportSkipped(sentence: string): void;
  reportFile(error: FileError): void;
  inform(sentence: string): void;
}

export class ViewRestore {
  /** True while a whole view state is being restored. */
  readonly running = new Signal(false);
  pending: ViewState | null = null;
  private readonly host: ViewRestoreHost;

  constructor(host: ViewRestoreHost) {
    this.host = host;
  }

  /** Restores this state in the session. */
  show(state: ViewState): Promise<void> {
    this.pending = state;
    return this.restore();
  }

  /** Without control, the page shows what other viewers chose, not what its link says. */
  dropWithoutControl(): void {
    const control = this.host.controlState.value;
    if (!this.pending || control.kind === "may_change") return;
    this.pending = null;
    this.host.inform(`Your view was not restored. ${describeControl(control)}`);
  }

  /** Restores the pending state, if there is one. */
  async restore(): Promise<void> {
    const { host, pending: state } = this;
    const hello = host.hello();
    if (!hello || !state) return;
    const { rpc, settings, capabilities } = host;
    const restoring: RestoreHost = {
      rpc,
      schema: () => settings.schema.value,
      supports: (method) => capabilities.has(method),
      isCurrent: () => host.hello() === hello && this.pending === state,
      reportSkipped: (sentence) => host.reportSkipped(sentence),
      reportFile: (error) => host.reportFile(error),
      ownsSession: () => host.ownsSession(hello),
    };
    this.running.set(true);
    host.begins();
    if (!(await restoreView(restoring, state))) return;
    this.pending = null;
    try {
      await host.arrived(hello);
    } finally {
      this.running.set(false);
    }
  }
}
