// Draws decoded frames on a canvas. The canvas takes the size of the frame, CSS scales it.
export class CanvasPainter {
  readonly canvas: HTMLCanvasElement | OffscreenCanvas;
  private readonly context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D;

  private drawn = false;

  constructor(canvas: HTMLCanvasElement | OffscreenCanvas) {
    const context = canvas.getContext("2d", { alpha: false }) as
      CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D | null;
    if (!context) throw new Error("This browser has no 2D canvas");
    this.canvas = canvas;
    this.context = context;
  }

  /** A copy of the canvas; null before the first frame. */
  async copy(): Promise<ImageBitmap | null> {
    return this.drawn ? createImageBitmap(this.canvas) : null;
  }

  draw(image: ImageBitmap | VideoFrame, width: number, height: number): void {
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    this.context.drawImage(image, 0, 0);
    this.drawn = true;
    image.close();
  }

  /** Draws an image over the whole frame. */
  overlay(image: OffscreenCanvas): void {
    this.context.drawImage(image, 0, 0, this.canvas.width, this.canvas.height);
  }
}
