// Shows a frame from another camera: a mesh through its depth plane, which has a vertex at each
// corner of the plane's samples, is textured with the frame and drawn from the new camera. Where
// surfaces come into view that the frame does not show, the mesh stretches the background, and
// beyond its border it goes on, more and more blurred.

import type { Vector3 } from "heliograph/json.ts";
import type { FrameDepth } from "heliograph/frame_depth.ts";
import { type CameraPose, basis } from "../common/camera_pose.ts";
import { dot, normalize, subtract } from "../common/vector.ts";

export type ViewCamera = Pick<CameraPose, "eye" | "target" | "up" | "vertical_fov">;

const vertexSource = `#version 300 es
precision highp float;
layout(location = 0) in float inverseDepth; // of a corner of samples, as a part of the nearest
uniform ivec2 size;           // of the plane
uniform float inverseNearest; // 1 / metres
uniform vec2 tangents;        // of half the frame's angles
uniform vec2 newTangents;
uniform mat3 turn;            // from the frame's view to the new one
uniform vec3 shift;           // of the eye, metres, in the new view
uniform float nearPlane;      // metres
out vec2 at;

void main() {
  int columns = size.x + 3; // one vertex more at each side, beyond the border
  ivec2 corner = ivec2(gl_VertexID % columns, gl_VertexID / columns) - 1;
  at = vec2(corner) / vec2(size);
  at = mix(at, vec2(-1.0), lessThan(corner, ivec2(0)));
  at = mix(at, vec2(2.0), greaterThan(corner, size));
  float inverse = inverseDepth * inverseNearest;
  vec3 ray = vec3((2.0 * at.x - 1.0) * tangents.x, (1.0 - 2.0 * at.y) * tangents.y, 1.0);
  vec3 seen = turn * ray - shift * inverse;
  float z = seen.z - 2.0 * nearPlane * inverse;
  gl_Position = vec4(seen.xy / newTangents, z, seen.z);
}`;

const fragmentSource = `#version 300 es
precision highp float;
uniform sampler2D frame;
in vec2 at;
out vec4 color;

// Beyond the border the frame goes on, the more blurred the farther away.
void main() {
  vec2 inside = clamp(at, 0.0, 1.0);
  float pixels = length((at - inside) * vec2(textureSize(frame, 0)));
  color = vec4(textureLod(frame, inside, log2(1.0 + 0.5 * pixels)).rgb, 1.0);
}`;

/** Samples that are farther apart than this part of the nearer one show an edge. */
const edge = 0.04;
/** Distances below this part of the nearest sample's are clipped. */
const nearestShare = 0.05;

interface Uniforms {
  [name: string]: WebGLUniformLocation | null;
}

export class Reprojection {
  readonly canvas: OffscreenCanvas;
  private readonly gl: WebGL2RenderingContext;
  private readonly uniforms: Uniforms = {};
  private source: FrameDepth | null = null;
  private aspect = 1;
  private meshSize = "";
  private indexCount = 0;

  /** Null where this browser has no WebGL2. */
  static create(): Reprojection | null {
    const canvas = new OffscreenCanvas(1, 1);
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false });
    return gl ? new Reprojection(canvas, gl) : null;
  }

  private constructor(canvas: OffscreenCanvas, gl: WebGL2RenderingContext) {
    this.canvas = canvas;
    this.gl = gl;
    const program = linkProgram(gl);
    gl.useProgram(program);
    const names = "size frame inverseNearest tangents newTangents turn shift nearPlane";
    for (const name of names.split(" ")) this.uniforms[name] = gl.getUniformLocation(program, name);
    gl.uniform1i(this.uniforms.frame!, 0);
    makeTexture(gl);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 1, gl.UNSIGNED_SHORT, true, 0, 0);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL); // the background lies at the far end
  }

  /** False once the browser has taken the graphics device away. */
  get usable(): boolean {
    return !this.gl.isContextLost();
  }

  /**
   * Takes the frame that `shown` shows. `coarse`: for slow devices, in half the size and with a
   * quarter of the triangles.
   */
  take(shown: HTMLCanvasElement | OffscreenCanvas, frameDepth: FrameDepth, coarse: boolean): void {
    const { gl } = this;
    const depth = coarse ? halved(frameDepth) : frameDepth;
    this.source = depth;
    const scale = coarse ? 0.5 : 1;
    const [width, height] = [Math.ceil(scale * shown.width), Math.ceil(scale * shown.height)];
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.aspect = shown.width / shown.height;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, shown);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.uniform2i(this.uniforms.size!, depth.width, depth.height);
    gl.bufferData(gl.ARRAY_BUFFER, cornersOf(depth), gl.DYNAMIC_DRAW);
    this.makeMesh(depth.width, depth.height);
  }

  /** Draws that frame on `canvas`, from another camera or as it is. */
  draw(seenFrom?: ViewCamera): void {
    const { gl, source, uniforms, canvas, aspect } = this;
    if (!source) return;
    const from: ViewCamera = { ...source, vertical_fov: source.verticalFov };
    const camera = seenFrom ?? from;
    const [axes, newAxes] = [axesOf(from), axesOf(camera)];
    const shift = subtract(camera.eye, from.eye);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniform1f(uniforms.inverseNearest!, 1 / source.nearest);
    gl.uniform1f(uniforms.nearPlane!, nearestShare * source.nearest);
    gl.uniform2fv(uniforms.tangents!, tangentsOf(from, aspect));
    gl.uniform2fv(uniforms.newTangents!, tangentsOf(camera, aspect));
    gl.uniform3fv(uniforms.shift!, newAxes.map((axis) => dot(axis, shift)));
    const columns = axes.map((axis) => newAxes.map((newAxis) => dot(newAxis, axis)));
    gl.uniformMatrix3fv(uniforms.turn!, false, columns.flat());
    gl.drawElements(gl.TRIANGLES, this.indexCount, gl.UNSIGNED_SHORT, 0);
  }

  /** Two triangles between four neighbours; the border's neighbours lie beyond it. */
  private makeMesh(width: number, height: number): void {
    const size = `${width}x${height}`;
    if (size === this.meshSize) return;
    this.meshSize = size;
    const [columns, rows] = [width + 3, height + 3];
    const indices: number[] = [];
    for (let y = 0; y + 1 < rows; y += 1) {
      for (let x = 0; x + 1 < columns; x += 1) {
        const first = y * columns + x;
        const below = first + columns;
        indices.push(first, below, first + 1, first + 1, below, below + 1);
      }
    }
    this.indexCount = indices.length;
    const { gl } = this;
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(indices), gl.STATIC_DRAW);
  }
}

/** Right, up and forward. */
function axesOf(camera: ViewCamera): [Vector3, Vector3, Vector3] {
  const { rightward, upward } = basis(camera);
  return [rightward, upward, normalize(subtract(camera.target, camera.eye))];
}

function tangentsOf(camera: ViewCamera, aspect: number): [number, number] {
  const vertical = Math.tan((camera.vertical_fov * Math.PI) / 360);
  return [vertical * aspect, vertical];
}

function linkProgram(gl: WebGL2RenderingContext): WebGLProgram {
  const program = gl.createProgram();
  const compile = (type: number, source: string): void => {
    const shader = gl.createShader(type);
    if (!shader) return; // the context is lost
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  };
  compile(gl.VERTEX_SHADER, vertexSource);
  compile(gl.FRAGMENT_SHADER, fragmentSource);
  gl.linkProgram(program);
  return program;
}

function makeTexture(gl: WebGL2RenderingContext): void {
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
}

/** Four samples become one. */
function merged(a: number, b: number, c: number, d: number): number {
  const most = Math.max(a, b, c, d);
  const isEdge = most - Math.min(a, b, c, d) > edge * most;
  return isEdge ? most : (a + b + c + d) >> 2;
}

/** The samples at these places, those beyond the border being the nearest within it. */
function mergedAt(depth: FrameDepth, x: number, y: number): number {
  const { width, height, samples } = depth;
  const inside = (value: number, size: number): number => Math.min(size - 1, Math.max(0, value));
  const [left, right] = [inside(x, width), inside(x + 1, width)];
  const [above, below] = [inside(y, height) * width, inside(y + 1, height) * width];
  const [a, b] = [samples[above + left]!, samples[above + right]!];
  return merged(a, b, samples[below + left]!, samples[below + right]!);
}

function halved(depth: FrameDepth): FrameDepth {
  const [width, height] = [(depth.width + 1) >> 1, (depth.height + 1) >> 1];
  const samples = new Uint16Array(width * height);
  for (let i = 0; i < samples.length; i += 1) {
    samples[i] = mergedAt(depth, 2 * (i % width), 2 * Math.floor(i / width));
  }
  return { ...depth, width, height, samples };
}

/**
 * The mesh's vertices: corners of samples, and beyond the border copies of it. Where the samples
 * around a corner show an edge, the nearest counts, so that what is in front keeps its shape.
 */
function cornersOf(depth: FrameDepth): Uint16Array<ArrayBuffer> {
  const columns = depth.width + 3;
  const corners = new Uint16Array(columns * (depth.height + 3));
  for (let i = 0; i < corners.length; i += 1) {
    corners[i] = mergedAt(depth, (i % columns) - 2, Math.floor(i / columns) - 2);
  }
  return corners;
}
