// Compares images: they are decoded and reduced in the browser.

const columns = 48;
const rows = 27;

/** Average colours on a coarse grid, components in [0, 1]. The page decodes the image. */
export async function thumbnail(page, png) {
  const values = await page.evaluate(
    async ({ base64, width, height }) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }), {
        resizeWidth: width,
        resizeHeight: height,
        resizeQuality: "high",
      });
      const context = new OffscreenCanvas(width, height).getContext("2d");
      context.drawImage(bitmap, 0, 0);
      return [...context.getImageData(0, 0, width, height).data];
    },
    { base64: Buffer.from(png).toString("base64"), width: columns, height: rows },
  );
  return values.filter((_, index) => index % 4 !== 3).map((value) => value / 255);
}

/** Mean and standard deviation over all cells and components. */
export function statistics(cells) {
  const mean = cells.reduce((sum, value) => sum + value, 0) / cells.length;
  const variance = cells.reduce((sum, value) => sum + (value - mean) ** 2, 0) / cells.length;
  return { mean, deviation: Math.sqrt(variance) };
}

/** Mean absolute difference of two thumbnails; 0 for equal images. */
export function difference(a, b) {
  return a.reduce((sum, value, index) => sum + Math.abs(value - b[index]), 0) / a.length;
}
