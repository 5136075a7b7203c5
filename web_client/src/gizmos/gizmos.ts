// Draws the handles of a section plane or a light over the view, with the camera of the page.
// Captures do not show them.

import type { Viewer } from "../session/viewer.ts";
import type { PointTool } from "../view/point_tool.ts";
import { Projection, type ViewPoint } from "../view/projection.ts";
import { tipOffset } from "./drag_math.ts";
import type { Gizmo, Handle } from "./gizmo.ts";
import { HandleInput } from "./handle_input.ts";
import { createHandleNode, describeHandleNode, placeHandleNode } from "./handle_node.ts";
import { lightGizmo } from "./light_gizmo.ts";
import { PlaneGizmos } from "./plane_gizmo.ts";
import { svgShape } from "./svg_shape.ts";

/** CSS pixels of handles from the anchor: across the view, and where they point at the eye. */
const moveReach = { reach: 90, least: 40 };
const turnReach = { reach: 130, least: 72 };

/** A signal of any value. */
interface Watchable {
  watch(listener: () => void): void;
}

interface GizmoParts {
  /** Where the handles are, over everything but dialogs. */
  root: HTMLElement;
  /** Where their lines are, over the view. */
  lines: HTMLElement;
  view: HTMLElement;
  /** Parts of the page that handles would cover. */
  covers: HTMLElement[];
  points: PointTool;
  comparison: Watchable & { readonly value: unknown };
}

export function mountGizmos(viewer: Viewer, parts: GizmoParts): void {
  const gizmos = new Gizmos(viewer, parts);
  const { membership, connection, restoring, handles } = viewer;
  const shown: readonly Watchable[] = [
    viewer.camera,
    viewer.frame,
    viewer.scene,
    viewer.section.planes,
    viewer.parts.lights,
    handles.target,
    membership.controlState,
    connection.state,
    restoring,
    parts.points.task,
    parts.comparison,
  ];
  for (const signal of shown) signal.watch(gizmos.schedule);
  new ResizeObserver(gizmos.schedule).observe(parts.lines);
}

class Gizmos {
  private readonly viewer: Viewer;
  private readonly parts: GizmoParts;
  private readonly planes: PlaneGizmos;
  private readonly input: HandleInput;
  private readonly svg = svgShape("svg", {});
  private readonly nodes = new Map<Handle["id"], HTMLElement>();
  private key = "";
  private scheduled = false;

  constructor(viewer: Viewer, parts: GizmoParts) {
    this.viewer = viewer;
    this.parts = parts;
    this.planes = new PlaneGizmos(viewer.section);
    this.input = new HandleInput({
      gizmo: () => this.gizmo(),
      projection: () => this.projection(),
      sceneSize: () => viewer.shown.size,
      turnReach: turnReach.reach,
    });
    parts.lines.append(this.svg);
  }

  readonly schedule = (): void => {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.draw();
    });
  };

  /** Null where this page may not change the session, and while clicks do something else. */
  private gizmo(): Gizmo | null {
    const { viewer, parts } = this;
    const target = viewer.handles.target.value;
    const scene = viewer.scene.value;
    const live = viewer.hello !== null && viewer.mayChange && !viewer.restoring.value;
    const busy = parts.points.task.value !== null || parts.comparison.value !== null;
    if (!target || !scene || !live || busy) return null;
    if (target.kind === "plane") return this.planes.of(target.index, scene);
    const light = viewer.parts.lights.value.find(({ name }) => name === target.name);
    return light ? lightGizmo(light, scene.bounds, viewer.parts) : null;
  }

  private projection(): Projection | null {
    const [camera, frame] = [this.viewer.camera.value, this.viewer.frame.value];
    const { clientWidth, clientHeight } = this.parts.lines;
    return camera && frame
      ? new Projection(camera, frame.width / frame.height, clientWidth, clientHeight)
      : null;
  }

  private draw(): void {
    const gizmo = this.gizmo();
    const projection = gizmo && this.projection();
    const key = gizmo && projection ? gizmo.key : "";
    if (key !== this.key) this.change(key, (projection && gizmo?.handles) ?? []);
    if (!gizmo || !projection) return;
    const lines = outlineOf(gizmo, projection);
    const covered = this.parts.covers.map((one) => one.getBoundingClientRect());
    for (const handle of gizmo.handles) {
      const node = this.nodes.get(handle.id);
      if (!node) continue;
      const place = placeOf(handle, gizmo, projection);
      const held = this.input.isDragging(node) || document.activeElement === node;
      node.hidden = !place || !(held || this.isFree(place.at, covered));
      if (!place) continue;
      describeHandleNode(node, handle);
      placeHandleNode(node, place.at, place.offset);
      if (!node.hidden) lines.push(...line(place.anchor, place.at, `axis-${handle.id}`));
    }
    this.svg.replaceChildren(...lines);
  }

  /** Other handles, or none. */
  private change(key: string, handles: readonly Handle[]): void {
    this.input.end(this.viewer.mayChange);
    this.key = key;
    this.nodes.clear();
    for (const handle of handles) {
      const node = createHandleNode(handle);
      this.input.attach(node, handle.id);
      node.addEventListener("wheel", this.passOn, { passive: false });
      this.nodes.set(handle.id, node);
    }
    this.parts.root.replaceChildren(...this.nodes.values());
    this.parts.root.hidden = key === "";
    this.svg.replaceChildren();
  }

  /** The wheel zooms under a handle as elsewhere in the view. */
  private readonly passOn = (event: WheelEvent): void => {
    event.preventDefault();
    this.parts.view.dispatchEvent(new WheelEvent(event.type, event));
  };

  /** Whether a handle there is in the view and covers no other part of the page. */
  private isFree({ x, y }: ViewPoint, covered: readonly DOMRect[]): boolean {
    const { left, top, width, height } = this.parts.lines.getBoundingClientRect();
    if (x < 0 || y < 0 || x > width || y > height) return false;
    return !covered.some(
      (rect) =>
        left + x >= rect.left &&
        left + x <= rect.right &&
        top + y >= rect.top &&
        top + y <= rect.bottom,
    );
  }
}

/** Null behind the eye. */
function placeOf(
  { deed }: Handle,
  { pose: { anchor } }: Gizmo,
  projection: Projection,
): { anchor: ViewPoint; at: ViewPoint; offset: ViewPoint } | null {
  const from = projection.point(anchor);
  const offset = deed.tip
    ? tipOffset(projection, anchor, deed.tip, deed.kind === "turn" ? turnReach : moveReach)
    : { x: 0, y: 0 };
  if (!from || !offset) return null;
  return { anchor: from, at: { x: from.x + offset.x, y: from.y + offset.y }, offset };
}

function outlineOf({ outline }: Gizmo, projection: Projection): SVGElement[] {
  return outline.flatMap((corner, i) => {
    const ends = projection.line(corner, outline[(i + 1) % outline.length] ?? corner);
    return ends ? line(...ends, "outline") : [];
  });
}

/** Twice: what lies below is a dark edge, so that it is seen on any background. */
function line(from: ViewPoint, to: ViewPoint, kind: string): SVGElement[] {
  const ends = { x1: from.x, y1: from.y, x2: to.x, y2: to.y };
  return ["edge", "stroke"].map((layer) =>
    svgShape("line", { class: `${layer} ${kind}`, ...ends }),
  );
}
