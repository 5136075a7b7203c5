// What the words of the settings mean, for those who have not read the papers.

import { element } from "../../widgets/element.ts";

const terms: [term: string, meaning: string][] = [
  ["Sample", "One attempt per pixel to find how much light arrives. More samples, less noise."],
  ["Accumulation", "A static view averages its samples, up to the number that is set."],
  ["Denoiser", "Makes a clean image of a few samples per pixel, from other frames and pixels."],
  ["History", "What a pixel has kept of the frames before. It follows surfaces as they move."],
  ["Disocclusion", "A surface comes into view and has no history yet: it is noisy for a moment."],
  [
    "Rectification",
    "Corrects a history that the current frame contradicts, such as a shadow that has moved on.",
  ],
  ["À-trous blur", "Averages neighbours in steps that double, but not across edges."],
  ["SVGF", "The denoiser that the others are compared with (Schied et al. 2017)."],
  ["Temporal antialiasing", "Smooths edges with samples of several frames."],
  ["Visibility", "How much of the light reaches a surface: shadows and ambient occlusion."],
  ["Radiance cache", "Indirect light that is kept at places in the scene and used by many pixels."],
  ["Reference", "Path tracing without shortcuts: slow, and right."],
];

export function createTerms(): HTMLElement {
  return element(
    "details",
    { class: "terms" },
    element("summary", {}, "What these words mean"),
    element(
      "dl",
      {},
      ...terms.flatMap(([term, meaning]) => [
        element("dt", {}, term),
        element("dd", {}, meaning),
      ]),
    ),
  );
}
