// Shows a frame from another camera: a mesh through its depth plane, which has a vertex at each
// corner of the plane's samples, is textured with the frame and drawn from the new camera. Where
// surfaces come into view that the frame does not show, the mesh stretches the background; beyond
// its border it mirrors the frame.

import type { Vector3 } from "heliograph/json.ts";
import type { FrameDepth } from "heliograph/frame_depth.ts";
import { type CameraPose, basis } from "../common/camera_pose.ts";
import { dot, normalize, subtract } from "../common/vector.ts";

export type ViewCamera = Pick<CameraPose, "eye" | "target" | "up" | "vertical_fov">;

const vertexSource = `#version 300 es
precision highp float;
precision highp usampler2D;
uniform usampler2D plane;
uniform float inverseNearest; // of the plane's values, 1 / metres
uniform vec2 tangents;        // of half the frame's angles
uniform vec2 newTangents;
uniform mat3 turn;            // from the frame's view to the new one
uniform vec3 shift;           // of the eye, metres, in the new view
uniform float nearPlane;      // metres
out vec2 at;

// Of a corner of samples: where they show an edge, the nearest counts, so that what is in front
// keeps its shape.
float inverseDepth(ivec2 corner, ivec2 size) {
  float least = 65535.0, most = 0.0, sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = clamp(corner - ivec2(i & 1, i >> 1), ivec2(0), size - 1);
    float value = float(texelFetch(plane, texel, 0).r);
    least = min(least, value);
    most = max(most, value);
    sum += value;
  }
  float value = most - least > 0.1 * most ? most : 0.25 * sum;
  return value / 65535.0 * inverseNearest;
}

void main() {
  ivec2 size = textureSize(plane, 0);
  int columns = size.x + 3; // one vertex more at each side, beyond the border
  ivec2 corner = ivec2(gl_VertexID % columns, gl_VertexID / columns) - 1;
  float inverse = inverseDepth(corner, size);
  at = vec2(corner) / vec2(size);
  at = mix(at, vec2(-1.0), lessThan(corner, ivec2(0)));
  at = mix(at, vec2(2.0), greaterThan(corner, size));
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
void main() {
  color = vec4(texture(frame, at).rgb, 1.0);
}`;

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
    const names = "plane frame inverseNearest tangents newTangents turn shift nearPlane";
    for (const name of names.split(" ")) this.uniforms[name] = gl.getUniformLocation(program, name);
    gl.uniform1i(this.uniforms.frame!, 0);
    gl.uniform1i(this.uniforms.plane!, 1);
    makeTexture(gl, gl.TEXTURE0, gl.LINEAR, gl.MIRRORED_REPEAT);
    makeTexture(gl, gl.TEXTURE1, gl.NEAREST, gl.CLAMP_TO_EDGE);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL); // the background lies at the far end
  }

  /** False once the browser has taken the graphics device away. */
  get usable(): boolean {
    return !this.gl.isContextLost();
  }

  /** Takes the frame that the canvas shows. */
  take(frame: HTMLCanvasElement | OffscreenCanvas, depth: FrameDepth): void {
    const { gl } = this;
    this.source = depth;
    if (this.canvas.width !== frame.width) this.canvas.width = frame.width;
    if (this.canvas.height !== frame.height) this.canvas.height = frame.height;
    gl.activeTexture(gl.TEXTURE0);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, frame);
    gl.activeTexture(gl.TEXTURE1);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
    const { width, height, samples } = depth;
    const [format, type] = [gl.RED_INTEGER, gl.UNSIGNED_SHORT];
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R16UI, width, height, 0, format, type, samples);
    this.makeMesh(width, height);
  }

  /** Draws that frame on `canvas`, from another camera or as it is. */
  draw(seenFrom?: ViewCamera): void {
    const { gl, source, uniforms, canvas } = this;
    if (!source) return;
    const aspect = canvas.width / canvas.height;
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

function makeTexture(gl: WebGL2RenderingContext, unit: number, filter: number, wrap: number): void {
  gl.activeTexture(unit);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
}
