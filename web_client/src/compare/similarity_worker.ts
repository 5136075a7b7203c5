// Compares pictures beside the page: two bitmaps in, their structural similarity out.

import { type GreyPicture, greyPicture, structuralSimilarity } from "./ssim.ts";

const comparedWidth = 320;

interface Question {
  id: number;
  pictures: [ImageBitmap, ImageBitmap];
}

const scope = self as unknown as {
  onmessage: ((event: MessageEvent<Question>) => void) | null;
  postMessage(message: { id: number; similarity: number }): void;
};
const canvas = new OffscreenCanvas(1, 1);
const context = canvas.getContext("2d", { willReadFrequently: true, alpha: false });

function shrunk(picture: ImageBitmap, width: number, height: number): GreyPicture {
  if (!context) throw new Error("This browser capabilities no 2D canvas");
  canvas.width = width;
  canvas.height = height;
  context.imageSmoothingQuality = "high";
  context.drawImage(picture, 0, 0, width, height);
  picture.close();
  return greyPicture(context.getImageData(0, 0, width, height).data, width, height);
}

scope.onmessage = ({ data: { id, pictures } }) => {
  const [first, second] = pictures;
  const width = Math.min(comparedWidth, first.width);
  const height = Math.max(8, Math.round((width * first.height) / first.width));
  const a = shrunk(first, width, height);
  const b = shrunk(second, width, height);
  scope.postMessage({ id, similarity: structuralSimilarity(a, b) });
};
