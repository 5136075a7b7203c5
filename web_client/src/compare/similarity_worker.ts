// Worker that compares frames: two bitmaps in, their structural similarity out.

import { type GreyImage, greyImage, structuralSimilarity } from "./ssim.ts";

const comparedWidth = 320;

interface Request {
  id: number;
  frames: [ImageBitmap, ImageBitmap];
}

const scope = self as unknown as {
  onmessage: ((event: MessageEvent<Request>) => void) | null;
  postMessage(message: { id: number; similarity: number }): void;
};
const canvas = new OffscreenCanvas(1, 1);
const context = canvas.getContext("2d", { willReadFrequently: true, alpha: false });

function greyscale(bitmap: ImageBitmap, width: number, height: number): GreyImage {
  if (!context) throw new Error("This browser has no 2D canvas");
  canvas.width = width;
  canvas.height = height;
  context.imageSmoothingQuality = "high";
  context.drawImage(bitmap, 0, 0, width, height);
  bitmap.close();
  return greyImage(context.getImageData(0, 0, width, height).data, width, height);
}

scope.onmessage = ({ data: { id, frames } }) => {
  const [first, second] = frames;
  const width = Math.min(comparedWidth, first.width);
  const height = Math.max(8, Math.round((width * first.height) / first.width));
  const a = greyscale(first, width, height);
  const b = greyscale(second, width, height);
  scope.postMessage({ id, similarity: structuralSimilarity(a, b) });
};
