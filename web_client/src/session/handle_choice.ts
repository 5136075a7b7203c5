// Whose handles are drawn over the view: a section plane's or a light's. They are shown while the list
// in the panel that has it can be seen.

import type { LightInfo, SceneInfo, SectionPlane } from "heliograph/messages.ts";
import { Signal } from "../common/signal.ts";

type HandleTarget = { kind: "plane"; index: number } | { kind: "light"; name: string };
type Kind = HandleTarget["kind"];

interface HandleChoiceHost {
  scene: Signal<SceneInfo | null>;
  section: { planes: Signal<readonly SectionPlane[]> };
  parts: { lights: Signal<LightInfo[]> };
}

export class HandleChoice {
  /** What has handles now. */
  readonly target = new Signal<HandleTarget | null>(null);
  private readonly host: HandleChoiceHost;
  /** Null before the first choice, "none" when the user has closed the handles. */
  private chosen: HandleTarget | "none" | null = null;
  private readonly listed = new Set<Kind>();
  private scene = "";

  constructor(host: HandleChoiceHost) {
    this.host = host;
    host.section.planes.watch(() => this.update());
    host.parts.lights.watch(() => this.update());
    host.scene.watch((scene) => {
      if (scene && scene.name !== this.scene) this.chosen = null;
      this.scene = scene?.name ?? this.scene;
      this.update();
    });
  }

  choose(target: HandleTarget): void {
    this.chosen = target;
    this.update();
  }

  /** Closes the handles of this target, or shows them. */
  toggle(target: HandleTarget): void {
    this.chosen = this.shows(target) ? "none" : target;
    this.update();
  }

  shows(target: HandleTarget): boolean {
    return sameTarget(this.target.value, target);
  }

  /** Whether the list of these can be seen in the panel. */
  setListed(kind: Kind, listed: boolean): void {
    if (listed) this.listed.add(kind);
    else this.listed.delete(kind);
    this.update();
  }

  /** A plane is going to be removed: those after it get lower indices. */
  planeRemoved(index: number): void {
    const { chosen } = this;
    if (!chosen || chosen === "none" || chosen.kind !== "plane" || chosen.index < index) return;
    this.chosen = chosen.index > index ? { kind: "plane", index: chosen.index - 1 } : null;
  }

  private update(): void {
    const target = this.find();
    if (!sameTarget(target, this.target.value)) this.target.set(target);
  }

  /** The chosen one or, before a choice, the only plane. */
  private find(): HandleTarget | null {
    const { chosen, listed, host } = this;
    const planes = host.section.planes.value;
    if (chosen === "none") return null;
    if (chosen && listed.has(chosen.kind)) {
      const exists =
        chosen.kind === "plane"
          ? chosen.index < planes.length
          : host.parts.lights.value.some(({ name }) => name === chosen.name);
      if (exists) return chosen;
    }
    return listed.has("plane") && planes.length === 1 ? { kind: "plane", index: 0 } : null;
  }
}

function sameTarget(a: HandleTarget | null, b: HandleTarget | null): boolean {
  if (!a || !b) return a === b;
  if (a.kind === "plane") return b.kind === "plane" && a.index === b.index;
  return b.kind === "light" && a.name === b.name;
}
