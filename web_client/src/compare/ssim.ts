// Structural similarity of two grey images (Wang et al. 2004), with windows of 8 x 8 pixels that
// overlap by half: close to the Gaussian form and fast enough for a live stream.

const windowSize = 8;
const stride = 4;
const k1 = (0.01 * 255) ** 2;
const k2 = (0.03 * 255) ** 2;

export interface GreyImage {
  width: number;
  height: number;
  /** Luma, 0 to 255, row by row from the top. */
  luma: Float32Array;
}

/** Luma of RGBA bytes by Rec. 709, on the encoded values as is usual for this measure. */
export function greyImage(rgba: Uint8ClampedArray, width: number, height: number): GreyImage {
  const luma = new Float32Array(width * height);
  for (let i = 0; i < luma.length; i += 1) {
    const at = 4 * i;
    luma[i] = 0.2126 * rgba[at]! + 0.7152 * rgba[at + 1]! + 0.0722 * rgba[at + 2]!;
  }
  return { width, height, luma };
}

/** Mean over all windows: 1 for equal images. Both must have the same size. */
export function structuralSimilarity(a: GreyImage, b: GreyImage): number {
  let sum = 0;
  let count = 0;
  for (let top = 0; top + windowSize <= a.height; top += stride) {
    for (let left = 0; left + windowSize <= a.width; left += stride) {
      sum += windowSimilarity(a, b, left, top);
      count += 1;
    }
  }
  return count > 0 ? sum / count : 1;
}

function windowSimilarity(a: GreyImage, b: GreyImage, left: number, top: number): number {
  let [sumA, sumB, sumAA, sumBB, sumAB] = [0, 0, 0, 0, 0];
  for (let y = top; y < top + windowSize; y += 1) {
    for (let at = y * a.width + left, end = at + windowSize; at < end; at += 1) {
      const [x, z] = [a.luma[at]!, b.luma[at]!];
      sumA += x;
      sumB += z;
      sumAA += x * x;
      sumBB += z * z;
      sumAB += x * z;
    }
  }
  const n = windowSize * windowSize;
  const [meanA, meanB] = [sumA / n, sumB / n];
  const varianceA = sumAA / n - meanA * meanA;
  const varianceB = sumBB / n - meanB * meanB;
  const covariance = sumAB / n - meanA * meanB;
  const numerator = (2 * meanA * meanB + k1) * (2 * covariance + k2);
  return numerator / ((meanA * meanA + meanB * meanB + k1) * (varianceA + varianceB + k2));
}
