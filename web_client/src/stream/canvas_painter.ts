// Puts decoded pictures on a canvas. The canvas takes the size of the picture and CSS scales it.
export class CanvasPainter {
  private readonly canvas: HTMLCanvasElement | OffscreenCanvas;
  private readonly context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D;

  private drawn = false;

  constructor(canvas: HTMLCanvasElement | OffscreenCanvas) {
    const context = canvas.getContext("2d", { alpha: false }) as
      | CanvasRenderingContext2D
      | OffscreenCanvasRenderingContext2D
      | null;
    if (!context) throw new Error("This browser capabilities no 2D canvas");
    this.canvas = canvas;
    this.context = context;
  }

  /** A copy of what is shown; null before the first picture. */
  async copy(): Promise<ImageBitmap | null> {
    return this.drawn ? createImageBitmap(this.canvas) : null;
  }

  draw(picture: ImageBitmap | VideoFrame, width: number, height: number): void {
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    this.context.drawImage(picture, 0, 0);
    this.drawn = true;
    picture.close();
  }
}
