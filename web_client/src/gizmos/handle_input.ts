// Drags and arrow keys on handles.

import type { Projection } from "../view/projection.ts";
import { sideOf } from "./drag_math.ts";
import type { Edit, Gizmo, Handle } from "./gizmo.ts";
import { type Deed, type Pose, dragged, stepped } from "./pose.ts";

/** What Shift makes of a drag. */
const finer = 0.1;
/** Steps of the arrow keys: parts of the scene's size and degrees; with Shift this many times. */
const keyMove = 1 / 200;
const keyTurn = 2;
const largeSteps = 5;

const arrows: Record<string, { right: number; up: number }> = {
  ArrowLeft: { right: -1, up: 0 },
  ArrowRight: { right: 1, up: 0 },
  ArrowUp: { right: 0, up: 1 },
  ArrowDown: { right: 0, up: -1 },
};

interface HandleInputHost {
  gizmo(): Gizmo | null;
  /** Of the camera that the view shows. */
  projection(): Projection | null;
  /** Largest extent of the scene in metres. */
  sceneSize(): number;
  /** Distance of handles that turn from their anchor, CSS pixels. */
  turnReach: number;
}

interface Drag {
  node: HTMLElement;
  pointer: number;
  x: number;
  y: number;
  /** Not limited to what may be shown, so that the handle waits for the pointer beyond a limit. */
  pose: Pose;
  deed: Deed;
  edit: Edit;
}

export class HandleInput {
  private readonly host: HandleInputHost;
  private drag: Drag | null = null;
  /** Of what is turned, since it was grasped or got the focus. */
  private side: 1 | -1 = 1;
  private drags = 0;

  constructor(host: HandleInputHost) {
    this.host = host;
  }

  isDragging(node: HTMLElement): boolean {
    return this.drag?.node === node;
  }

  attach(node: HTMLElement, id: Handle["id"]): void {
    node.addEventListener("pointerdown", (event) => this.press(node, id, event));
    node.addEventListener("pointermove", (event) => this.move(event));
    node.addEventListener("pointerup", (event) => this.released(event, true));
    node.addEventListener("pointercancel", (event) => this.released(event, false));
    node.addEventListener("keydown", (event) => this.step(id, event));
    node.addEventListener("focus", () => this.findSide(id));
  }

  /** Ends a drag: with a step of the history, or without, where the page may no longer change. */
  end(keeps: boolean): void {
    const drag = this.finish();
    if (drag && keeps) drag.edit.keep(`drag ${this.drags}`);
  }

  private handle(id: Handle["id"]): { gizmo: Gizmo; deed: Deed } | null {
    const gizmo = this.host.gizmo();
    const deed = gizmo?.handles.find((one) => one.id === id)?.deed;
    return gizmo && deed ? { gizmo, deed } : null;
  }

  private findSide(id: Handle["id"]): void {
    const tip = this.handle(id)?.deed.tip;
    const projection = this.host.projection();
    if (tip && projection) this.side = sideOf(tip, projection.directions.forward);
  }

  private press(node: HTMLElement, id: Handle["id"], event: PointerEvent): void {
    const found = this.handle(id);
    if (!found || this.drag || event.button !== 0) return;
    event.preventDefault(); // it selects no text
    node.focus({ preventScroll: true });
    node.setPointerCapture(event.pointerId);
    this.findSide(id);
    const { gizmo, deed } = found;
    this.drags += 1;
    this.drag = {
      node,
      pointer: event.pointerId,
      x: event.clientX,
      y: event.clientY,
      pose: gizmo.pose,
      deed,
      edit: gizmo.begin(deed.kind),
    };
    node.classList.add("grabbing");
    addEventListener("keydown", this.keyDuringDrag, true);
  }

  private move({ pointerId, clientX, clientY, shiftKey }: PointerEvent): void {
    const { drag } = this;
    const projection = this.host.projection();
    if (!drag || drag.pointer !== pointerId || !projection) return;
    const rate = shiftKey ? finer : 1;
    const delta = { x: rate * (clientX - drag.x), y: rate * (clientY - drag.y) };
    drag.x = clientX;
    drag.y = clientY;
    if (delta.x === 0 && delta.y === 0) return;
    const { side } = this;
    const reach = this.host.turnReach;
    drag.pose = dragged(drag.pose, drag.deed, projection, delta, { reach, side });
    drag.edit.show(drag.pose);
  }

  private released({ pointerId }: PointerEvent, keeps: boolean): void {
    if (this.drag?.pointer !== pointerId) return;
    if (keeps) this.end(true);
    else this.finish()?.edit.revert();
  }

  /** Escape takes the drag back; other keys wait for its end, undo among them. */
  private readonly keyDuringDrag = (event: KeyboardEvent): void => {
    event.stopImmediatePropagation();
    if (event.key !== "Shift") event.preventDefault();
    if (event.key === "Escape") this.finish()?.edit.revert();
  };

  private finish(): Drag | null {
    const { drag } = this;
    if (!drag) return null;
    this.drag = null;
    removeEventListener("keydown", this.keyDuringDrag, true);
    drag.node.classList.remove("grabbing");
    if (drag.node.hasPointerCapture(drag.pointer)) drag.node.releasePointerCapture(drag.pointer);
    return drag;
  }

  private step(id: Handle["id"], event: KeyboardEvent): void {
    const arrow = arrows[event.key];
    const found = this.handle(id);
    const projection = this.host.projection();
    const hasModifier = event.ctrlKey || event.metaKey || event.altKey;
    if (!arrow || !found || !projection || hasModifier) return;
    event.preventDefault();
    const { gizmo, deed } = found;
    const unit =
      deed.kind === "turn" ? (keyTurn * Math.PI) / 180 : keyMove * this.host.sceneSize();
    const size = event.shiftKey ? largeSteps * unit : unit;
    const steps = { right: size * arrow.right, up: size * arrow.up };
    const edit = gizmo.begin(deed.kind);
    edit.show(stepped(gizmo.pose, deed, projection, steps, this.side));
    edit.keep(`keys ${id}`);
  }
}
