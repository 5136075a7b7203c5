// Draws over the view what viewers have added to the scene: lines in an SVG, texts as labels. It
// follows the camera of the page; captures show it only on request, drawn by the server.

import type { Vector3 } from "heliograph/json.ts";
import type { Annotation, Measurement, Snap } from "heliograph/messages.ts";
import { add, cross, dot, length, normalize, scale, subtract } from "../common/vector.ts";
import type { Viewer } from "../session/viewer.ts";
import type { PointTool } from "../view/point_tool.ts";
import { Projection, type ViewPoint } from "../view/projection.ts";
import { element } from "../widgets/element.ts";

const svgNamespace = "http://www.w3.org/2000/svg";
const arcSteps = 16;
/** Of the shorter arm. */
const arcRadius = 0.3;
const dotRadius = 3.5;
const pinRadius = 6;
const hiddenIntervalMs = 200;
/** Corners of a box whose indices differ in one bit share an edge. */
const boxEdges = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) =>
  [1, 2, 4].filter((bit) => (corner & bit) === 0).map((bit) => [corner, corner | bit] as const),
);

/** A signal of any value. */
interface Watchable {
  watch(listener: () => void): void;
}

export function mountMarks(root: HTMLElement, viewer: Viewer, tool: PointTool): void {
  const svg = document.createElementNS(svgNamespace, "svg");
  const labels = element("div", {});
  root.append(svg, labels);
  const { measurements, annotations } = viewer.marks;
  let scheduled = false;
  const draw = (): void => {
    scheduled = false;
    const [camera, frame] = [viewer.camera.value, viewer.frame.value];
    const { clientWidth, clientHeight } = root;
    const drawing = new Drawing(
      camera && frame
        ? new Projection(camera, frame.width / frame.height, clientWidth, clientHeight)
        : null,
    );
    if (viewer.scene.value) {
      for (const one of measurements.list.value) drawMeasurement(drawing, one);
      for (const one of annotations.list.value) {
        drawing.pin(one, annotations.hidden.value.has(one.id));
      }
      const draft = annotations.draft.value;
      if (draft) drawing.marker(draft);
    }
    drawPending(drawing, tool);
    if (svg.childElementCount + labels.childElementCount + drawing.shapes.length === 0) return;
    svg.replaceChildren(...drawing.shapes);
    labels.replaceChildren(...drawing.labels);
  };
  const schedule = (): void => {
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(draw);
  };
  const shown: readonly Watchable[] = [
    viewer.camera,
    viewer.frame,
    viewer.scene,
    measurements.list,
    annotations.list,
    annotations.hidden,
    annotations.draft,
    tool.points,
    tool.preview,
  ];
  for (const signal of shown) signal.watch(schedule);
  watchHidden(viewer);
  tool.task.watch((task) => root.classList.toggle("placing", task !== null));
  new ResizeObserver(schedule).observe(root);
}

/** Asks which annotations are hidden when what the frames show has changed, a few times a second. */
function watchHidden({ marks, frame, animation }: Viewer): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let shown = "";
  const ask = (): void => {
    timer ??= setTimeout(() => {
      timer = undefined;
      void marks.annotations.readHidden();
    }, hiddenIntervalMs);
  };
  frame.watch((drawn) => {
    if (drawn && `${drawn.stateRev}` === shown && !animation.value?.playing) return;
    shown = `${drawn?.stateRev}`;
    ask();
  });
  marks.annotations.list.watch(ask);
}

function drawMeasurement(drawing: Drawing, { id, kind, text, points, bounds }: Measurement): void {
  const places = points.map(({ position }) => position as Vector3);
  const [a, b, c] = places;
  if (kind === "distance" && a && b) {
    drawing.line(a, b);
    drawing.label(id, middle(a, b), text);
  } else if (kind === "angle" && a && b && c) {
    drawing.line(b, a);
    drawing.line(b, c);
    const arc = arcBetween(a, b, c);
    drawing.path(arc);
    drawing.label(id, arc[arcSteps / 2] as Vector3, text);
  } else if (bounds) {
    const corner = (index: number): Vector3 =>
      [0, 1, 2].map((axis) => (index & (1 << axis) ? bounds.max : bounds.min)[axis]) as Vector3;
    for (const [from, to] of boxEdges) drawing.line(corner(from), corner(to), "box");
    drawing.label(id, middle(corner(2), corner(7)), text);
  }
  for (const place of places) drawing.dot(place);
}

/** What a click would choose and the points before it. */
function drawPending(drawing: Drawing, tool: PointTool): void {
  const preview = tool.preview.value;
  const places = tool.points.value.map(({ position }) => position as Vector3);
  const all = preview?.position ? [...places, preview.position] : places;
  all.slice(1).forEach((place, i) => drawing.line(all[i] as Vector3, place, "pending"));
  for (const place of places) drawing.dot(place);
  if (preview) drawing.marker(preview);
}

class Drawing {
  readonly shapes: SVGElement[] = [];
  readonly labels: HTMLElement[] = [];
  private readonly projection: Projection | null;

  constructor(projection: Projection | null) {
    this.projection = projection;
  }

  line(from: Vector3, to: Vector3, kind = ""): void {
    const ends = this.projection?.line(from, to);
    if (!ends) return;
    const [{ x: x1, y: y1 }, { x: x2, y: y2 }] = ends;
    // Twice: what lies below is a dark edge, so that it is seen on any background.
    for (const layer of ["edge", "stroke"]) this.shape("line", `${layer} ${kind}`, { x1, y1, x2, y2 });
  }

  path(points: readonly Vector3[]): void {
    points.slice(1).forEach((to, i) => this.line(points[i] as Vector3, to, "arc"));
  }

  dot(position: Vector3): void {
    const at = this.projection?.point(position);
    if (at) this.shape("circle", "dot", { cx: at.x, cy: at.y, r: dotRadius });
  }

  /** Its shape tells what attracts the point. */
  marker({ position, feature }: Snap): void {
    const at = position && this.projection?.point(position);
    if (!at) return;
    const { x, y } = at;
    if (feature === "face") this.shape("circle", "marker", { cx: x, cy: y, r: 5 });
    else if (feature === "vertex") {
      this.shape("rect", "marker", { x: x - 6, y: y - 6, width: 12, height: 12 });
    } else {
      this.shape("path", "marker", { d: `M${x} ${y - 8} l7 14 h-14 Z` });
    }
  }

  label(id: number, position: Vector3, text: string): void {
    const at = this.projection?.point(position);
    if (at) this.labels.push(labelAt(at, `measurement-${id}`, text));
  }

  pin({ id, text, author, position }: Annotation, hidden: boolean): void {
    const at = this.projection?.point(position);
    if (!at) return;
    const state = hidden ? " hidden-mark" : "";
    this.shape("circle", `pin${state}`, { cx: at.x, cy: at.y, r: pinRadius });
    const label = element(
      "span",
      { class: `mark-label note-label${state}`, "data-mark": `annotation-${id}` },
      author ? element("b", {}, author) : null,
      element("span", {}, text),
    );
    label.style.translate = `${(at.x + 2 * pinRadius).toFixed(1)}px calc(${at.y.toFixed(1)}px - 50%)`;
    this.labels.push(label);
  }

  private shape(name: string, kind: string, attributes: Record<string, number | string>): void {
    const node = document.createElementNS(svgNamespace, name);
    node.setAttribute("class", kind.trim());
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, String(value));
    this.shapes.push(node);
  }
}

function labelAt({ x, y }: ViewPoint, mark: string, text: string): HTMLElement {
  const label = element("span", { class: "mark-label measure-label", "data-mark": mark }, text);
  label.style.translate = `calc(${x.toFixed(1)}px - 50%) calc(${y.toFixed(1)}px - 50%)`;
  return label;
}

function middle(a: Vector3, b: Vector3): Vector3 {
  return scale(add(a, b), 0.5);
}

/** Points of the arc at b from the direction of a to that of c. */
function arcBetween(a: Vector3, b: Vector3, c: Vector3): Vector3[] {
  const [first, second] = [subtract(a, b), subtract(c, b)];
  const radius = arcRadius * Math.min(length(first), length(second));
  const along = normalize(first);
  const normal = cross(along, normalize(second));
  const across = cross(normalize(normal), along);
  const angle = Math.atan2(length(normal), dot(along, normalize(second)));
  return Array.from({ length: arcSteps + 1 }, (_, i) => {
    const turn = (angle * i) / arcSteps;
    const direction = add(scale(along, Math.cos(turn)), scale(across, Math.sin(turn)));
    return add(b, scale(direction, radius));
  });
}
