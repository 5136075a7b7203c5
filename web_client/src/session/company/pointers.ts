// What the other viewers point at, and what this page's user does. Points are in the scene, since
// cameras and windows differ.

import type { Vector3 } from "heliograph/json.ts";
import type { Notifications, PointerSetParams } from "heliograph/messages.ts";
import { preferences } from "../../common/preferences.ts";
import { Signal } from "../../common/signal.ts";

/** Between two positions that are sent: at most 15 a second. */
const intervalMs = 70;
/** A pointer that has not moved for so long fades. */
const restAfterMs = 5000;
const preferenceKey = "pointer";

export interface Pointer {
  viewer: string;
  /** Null: the viewer has none. */
  name: string | null;
  position: Vector3;
  /** Whether it has not moved for some time. */
  faded: boolean;
}

/** In fractions of the view's width and height. */
interface ViewPlace {
  x: number;
  y: number;
}

interface PointersHost {
  /** Tells the server; without position: the pointer has left the view. */
  send(params: PointerSetParams): void;
  /** Whether the server takes pointers and another viewer sees them. */
  hasCompany(): boolean;
  /** The surface at a place of the view, world space; null where none is known. */
  surfaceAt(place: ViewPlace): Promise<Vector3 | null>;
  /** The point there at the distance of the camera's target; null without a camera. */
  targetPlaneAt(place: ViewPlace): Vector3 | null;
}

export class Pointers {
  /** Those of other viewers. */
  readonly others = new Signal<readonly Pointer[]>([]);
  /** Whether others see this page's pointer. */
  readonly shared = new Signal(preferences.flag(preferenceKey, true));
  private readonly host: PointersHost;
  private readonly rests = new Map<string, ReturnType<typeof setTimeout>>();
  private place: ViewPlace | null = null;
  /** Where it is has not been sent yet. */
  private moved = false;
  private sending = false;
  /** Others see it. */
  private shown = false;

  constructor(host: PointersHost) {
    this.host = host;
  }

  share(shared: boolean): void {
    preferences.setFlag(preferenceKey, shared);
    this.shared.set(shared);
    if (!shared) this.left();
  }

  /** The user's pointer is at this place. */
  movedTo(place: ViewPlace): void {
    if (!this.shared.value || !this.host.hasCompany()) return;
    this.place = place;
    this.moved = true;
    void this.sendAll();
  }

  /** It has left the view. */
  left(): void {
    this.place = null;
    this.moved = false;
    if (this.shown) this.host.send({});
    this.shown = false;
  }

  /** A notification about the pointer of another viewer. */
  take({ viewer, name, position }: Notifications["pointer.changed"]): void {
    clearTimeout(this.rests.get(viewer));
    this.rests.delete(viewer);
    const rest = this.others.value.filter((one) => one.viewer !== viewer);
    if (!position) {
      if (rest.length < this.others.value.length) this.others.set(rest);
      return;
    }
    this.others.set([...rest, { viewer, name, position, faded: false }]);
    this.rests.set(
      viewer,
      setTimeout(() => this.fade(viewer), restAfterMs),
    );
  }

  /** The server knows this page's pointer no longer; with `others`, nor does the page theirs. */
  forget(others: boolean): void {
    this.shown = false;
    if (!others) return;
    for (const timer of this.rests.values()) clearTimeout(timer);
    this.rests.clear();
    this.others.set([]);
  }

  private fade(viewer: string): void {
    const faded = (one: Pointer): Pointer =>
      one.viewer === viewer ? { ...one, faded: true } : one;
    this.others.set(this.others.value.map(faded));
  }

  /** One after the other, so that a slow answer holds the next question back. */
  private async sendAll(): Promise<void> {
    if (this.sending) return;
    this.sending = true;
    while (this.place && this.moved) {
      this.moved = false;
      const surface = await this.host.surfaceAt(this.place);
      // It may have left or moved on while the server was asked.
      const position = surface ?? (this.place && this.host.targetPlaneAt(this.place));
      if (this.place && position) {
        this.host.send({ position });
        this.shown = true;
      }
      await new Promise((resolve) => setTimeout(resolve, intervalMs));
    }
    this.sending = false;
  }
}
