// Whether the person at this page may change what all see, and if not, why.

import type { Hello, SessionInfo, ViewerInfo } from "heliograph/messages.ts";

export type ControlState =
  | { kind: "may_change" }
  /** The token lets this page watch only. */
  | { kind: "watching" }
  /** Only one viewer may change things, and it is this one. */
  | { kind: "other"; name: string }
  /** Only one viewer may change things, and nobody took that place yet. */
  | { kind: "nobody" };

export function controlStateOf(session: SessionInfo | null, role: Hello["role"]): ControlState {
  if (role === "view") return { kind: "watching" };
  const me = session?.viewers.find(({ you }) => you);
  if (!session || !me || me.control) return { kind: "may_change" };
  if (session.control === "everyone") return { kind: "watching" };
  const index = session.viewers.findIndex(({ control }) => control);
  const holder = session.viewers[index];
  return holder ? { kind: "other", name: nameOf(holder, index) } : { kind: "nobody" };
}

/** One sentence for the person; empty where there is nothing to explain. */
export function explained(controlState: ControlState): string {
  switch (controlState.kind) {
    case "may_change":
      return "";
    case "watching":
      return "You are here to watch: your access does not let you change anything.";
    case "other":
      return `${controlState.name} is in control and can hand it over to you.`;
    case "nobody":
      return "Nobody is in control at the moment.";
  }
}

/** What a viewer is called; the number is its place in the order of arrival, from 0. */
export function nameOf({ name }: ViewerInfo, index: number): string {
  return name || `Viewer ${index + 1}`;
}
