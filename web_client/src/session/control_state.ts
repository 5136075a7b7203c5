// Whether this page may change the session, and if not, why.

import type { Hello, SessionInfo, ViewerInfo } from "heliograph/messages.ts";

export type ControlState =
  | { kind: "may_change" }
  /** The access token is read-only. */
  | { kind: "read_only" }
  /** The camera is this page's own; everything else follows a session. */
  | { kind: "looks_around" }
  /** Another viewer has exclusive control. */
  | { kind: "other"; name: string }
  /** Control is exclusive, and no viewer has it. */
  | { kind: "unclaimed" };

export function controlStateOf(
  session: SessionInfo | null,
  role: Hello["role"] | undefined,
): ControlState {
  if (session?.follows) return { kind: "looks_around" };
  if (role === "view") return { kind: "read_only" };
  const me = session?.viewers.find(({ you }) => you);
  if (!session || !me || me.control) return { kind: "may_change" };
  if (session.control === "shared") return { kind: "read_only" };
  const index = session.viewers.findIndex(({ control }) => control);
  const holder = session.viewers[index];
  return holder ? { kind: "other", name: viewerName(holder, index) } : { kind: "unclaimed" };
}

/** One sentence for the user; empty where there is nothing to explain. */
export function describeControl(state: ControlState): string {
  switch (state.kind) {
    case "may_change":
      return "";
    case "read_only":
      return "View only: you can't change anything.";
    case "looks_around":
      return "You look around on your own. Everything else follows the shared session.";
    case "other":
      return `${state.name} is in control and can hand it over to you.`;
    case "unclaimed":
      return "No viewer is in control at the moment.";
  }
}

/** The name of a viewer; `index` is its position in the order of arrival, from 0. */
export function viewerName({ name }: ViewerInfo, index: number): string {
  return name || `Viewer ${index + 1}`;
}
