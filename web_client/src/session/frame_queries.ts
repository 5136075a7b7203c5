// Questions about the frame: files of it, and the surface at a point.

import type { Vector3 } from "heliograph/json.ts";
import type { Capture, FrameCaptureParams, Inspection, Pick, Snap } from "heliograph/messages.ts";
import type { RpcPeer } from "heliograph/rpc.ts";
import { captureBlob, thumbnailUrl } from "../common/image_files.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";

const captureTimeoutMs = 120_000;

interface FrameQueriesHost {
  rpc: RpcPeer;
  capabilities: ServerCapabilities;
  /** The buffer that is shown. */
  buffer(): string;
  /** Where a point of the view lies in the frame, both in fractions of width and height. */
  inFrame(x: number, y: number): { x: number; y: number };
  report(error: unknown): void;
}

export class FrameQueries {
  private readonly host: FrameQueriesHost;

  constructor(host: FrameQueriesHost) {
    this.host = host;
  }

  /** The surface at a point, given in fractions of the view's size from the top left. */
  async pick(x: number, y: number): Promise<Pick | null> {
    if (!this.host.capabilities.has("scene.pick")) return null;
    try {
      const pick = await this.host.rpc.request("scene.pick", this.host.inFrame(x, y));
      return pick.hit ? pick : null;
    } catch (error) {
      this.host.report(error);
      return null;
    }
  }

  /** The surface at a point of the view, world space; null where none is known. Reports no errors. */
  async surfaceAt(x: number, y: number): Promise<Vector3 | null> {
    if (!this.host.capabilities.has("scene.pick")) return null;
    try {
      return (await this.host.rpc.request("scene.pick", this.host.inFrame(x, y))).position;
    } catch {
      return null;
    }
  }

  /**
   * The exact point of a surface at a point of the view, or a vertex or edge near it unless `free`;
   * null where there is none. Reports no errors.
   */
  async snap(x: number, y: number, free: boolean): Promise<Snap | null> {
    const attract = { vertices: !free, edges: !free };
    try {
      const request = { ...this.host.inFrame(x, y), ...attract };
      const snap = await this.host.rpc.request("scene.snap", request);
      return snap.hit ? snap : null;
    } catch {
      return null;
    }
  }

  /** The values of all buffers at a point of the view. */
  async inspect(x: number, y: number): Promise<Inspection> {
    return this.host.rpc.request("frame.inspect", this.host.inFrame(x, y));
  }

  /**
   * A buffer as a file; by default the one that is shown, converged. `marks`: with measurements and
   * annotations drawn over it, which only images of the output can have.
   */
  async capture(
    buffer = this.host.buffer(),
    format: FrameCaptureParams["format"] = "png",
    samples?: number,
    marks = false,
  ): Promise<Capture> {
    const params: FrameCaptureParams = { buffer, format };
    if (samples !== undefined) params.samples = samples;
    if (marks) params.marks = true;
    return this.host.rpc.request("frame.capture", params, captureTimeoutMs);
  }

  /** A buffer of the frame as a small image, in a data URL; by default converged. */
  async thumbnail(buffer: string, width: number, samples?: number): Promise<string> {
    const format = this.host.capabilities.captureFormats.value.has("jpeg") ? "jpeg" : "png";
    return thumbnailUrl(captureBlob(await this.capture(buffer, format, samples)), width);
  }
}
