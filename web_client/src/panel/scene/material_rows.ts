// The factors of a material beyond colour, roughness and metalness: what it emits, how strong its
// textures are, and those of glTF's extensions. A row for each that the material has.

import type { Vector3 } from "heliograph/json.ts";
import type { MaterialInfo, MaterialPatch } from "heliograph/messages.ts";
import { displayColour, linearColour } from "../../common/colour.ts";
import { element, setText } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";

type NumberMember =
  | "normal_scale"
  | "occlusion_strength"
  | "ior"
  | "specular"
  | "clearcoat"
  | "clearcoat_roughness"
  | "clearcoat_normal_scale"
  | "sheen_roughness"
  | "iridescence"
  | "iridescence_ior"
  | "iridescence_thickness_minimum"
  | "iridescence_thickness_maximum"
  | "anisotropy"
  | "anisotropy_rotation"
  | "diffuse_transmission"
  | "transmission"
  | "thickness"
  | "attenuation_distance"
  | "dispersion";
type ColourMember =
  | "specular_color"
  | "sheen_color"
  | "diffuse_transmission_color"
  | "attenuation_color";

type SliderParts = Parameters<typeof createSliderRow>[0];
interface SliderFactor extends SliderParts {
  member: NumberMember;
  /** The texture without which the factor changes nothing. */
  needs?: string;
  /** Whether the factor changes something of a material; always, if left out. */
  shows?: Condition;
}
interface ColourFactor {
  member: ColourMember;
  label: string;
  shows?: Condition;
}
type Condition = (material: MaterialInfo) => boolean;

/** Light passes below the surface, straight or scattered. */
const letsLightThrough: Condition = ({ transmission, diffuse_transmission: diffuse }) =>
  transmission !== undefined || (diffuse ?? 0) > 0;

const slider = (
  member: NumberMember,
  label: string,
  description: string,
  rest: Partial<SliderFactor> = {},
): SliderFactor => ({
  member,
  label,
  description,
  unit: "",
  minimum: 0,
  maximum: 1,
  scale: "linear",
  ...rest,
});

export const factors: readonly (SliderFactor | ColourFactor)[] = [
  slider("normal_scale", "Normal scale", "How strong the bumps of the normal texture are.", {
    maximum: 4,
    needs: "normal",
  }),
  slider("occlusion_strength", "Occlusion", "How much the occlusion texture darkens.", {
    needs: "occlusion",
  }),
  slider("ior", "Index of refraction", "Water has 1.33, glass 1.5, diamond 2.4.", {
    minimum: 1,
    maximum: 3,
  }),
  slider("specular", "Specular", "Strength of the reflection of what is no metal."),
  { member: "specular_color", label: "Specular colour" },
  slider("clearcoat", "Clear coat", "Fraction of the surface under a layer of lacquer."),
  slider("clearcoat_roughness", "Coat roughness", "From a glossy (0) to a matt coat (1)."),
  slider("clearcoat_normal_scale", "Coat normal scale", "How strong the bumps of the coat are.", {
    maximum: 4,
    needs: "clearcoat_normal",
  }),
  { member: "sheen_color", label: "Sheen colour" },
  slider("sheen_roughness", "Sheen roughness", "From silk (0) to velvet and dust (1)."),
  slider("iridescence", "Iridescence", "Fraction under a thin film, as on soap bubbles and oil."),
  slider("iridescence_ior", "Film index of refraction", "Water has 1.33, oil 1.5.", {
    minimum: 1,
    maximum: 3,
  }),
  slider("iridescence_thickness_minimum", "Least film thickness", "Where its texture is black.", {
    unit: "nanometres",
    maximum: 2000,
    needs: "iridescence_thickness",
  }),
  slider("iridescence_thickness_maximum", "Film thickness", "It makes the colours.", {
    unit: "nanometres",
    maximum: 2000,
  }),
  slider("anisotropy", "Anisotropy", "How much rougher it is in one direction, as brushed metal."),
  slider("anisotropy_rotation", "Anisotropy rotation", "Of the direction in which it is rougher.", {
    unit: "radians",
    minimum: -3.15,
    maximum: 3.15,
  }),
  slider(
    "diffuse_transmission",
    "Diffuse transmission",
    "How much of the scattered light leaves at the other side, as of leaves, paper and lampshades.",
  ),
  { member: "diffuse_transmission_color", label: "Diffuse transmission colour" },
  slider("transmission", "Transmission", "Fraction of light that passes. Shadows keep the file's."),
  slider("thickness", "Thickness", "How much there is to pass below the surface; 0: a thin wall.", {
    unit: "metres",
    maximum: 10,
    scale: "cubic",
    shows: letsLightThrough,
  }),
  slider(
    "attenuation_distance",
    "Attenuation distance",
    "After so much, white light has the attenuation colour; 0: it never has.",
    { unit: "metres", maximum: 10, scale: "cubic", shows: letsLightThrough },
  ),
  { member: "attenuation_color", label: "Attenuation colour", shows: letsLightThrough },
  slider("dispersion", "Dispersion", "How far the colours are bent apart; diamond has 0.36.", {
    maximum: 2,
  }),
];

interface Emission {
  /** Linear; its largest component is 1. */
  colour: Vector3;
  strength: number;
}

/** What is emitted, as a colour and how much there is of it; black is white of strength 0. */
export function emissionOf(emissive: Vector3): Emission {
  const strength = Math.max(...emissive);
  if (strength <= 0) return { colour: [1, 1, 1], strength: 0 };
  return { colour: emissive.map((value) => value / strength) as Vector3, strength };
}

/** The radiance of so much of a colour, however dark that is; black emits nothing. */
export function radianceOf(colour: Vector3, strength: number): Vector3 {
  const largest = Math.max(...colour);
  return colour.map((value) => (largest > 0 ? (value / largest) * strength : 0)) as Vector3;
}

interface MaterialRows {
  nodes: HTMLElement[];
  show(material: MaterialInfo): void;
}

type Patch = (change: MaterialPatch) => void;

export function createMaterialRows(patch: Patch): MaterialRows {
  const rows = [
    createEmissionRows(patch),
    ...factors.map((factor) =>
      "scale" in factor ? createSlider(factor, patch) : createColour(factor, patch),
    ),
    createCutoff(),
  ];
  return {
    nodes: rows.flatMap(({ nodes }) => nodes),
    show: (material) => {
      for (const row of rows) row.show(material);
    },
  };
}

/** Whether a material has the factor, and it changes something of it. */
export function isOffered(
  factor: Pick<SliderFactor, "needs" | "shows"> & { member: NumberMember | ColourMember },
  material: MaterialInfo,
): boolean {
  const { member, needs, shows } = factor;
  if (material[member] === undefined) return false;
  if (needs !== undefined && !material.textures.includes(needs)) return false;
  return shows === undefined || shows(material);
}

function createSlider(factor: SliderFactor, patch: Patch): MaterialRows {
  const row = createSliderRow(factor, (value) => patch({ [factor.member]: value }));
  const show = (material: MaterialInfo): void => {
    const value = material[factor.member];
    row.node.hidden = !isOffered(factor, material);
    if (value !== undefined) row.show(value);
  };
  return { nodes: [row.node], show };
}

function createColour(factor: ColourFactor, patch: Patch): MaterialRows {
  const { member, label } = factor;
  const input = colourInput(member, label, (colour) => patch({ [member]: colour }));
  const node = field(label, input);
  const show = (material: MaterialInfo): void => {
    const value = material[member];
    node.hidden = !isOffered(factor, material);
    if (value !== undefined) input.value = displayColour(value);
  };
  return { nodes: [node], show };
}

function colourInput(
  name: string,
  label: string,
  report: (colour: Vector3) => void,
): HTMLInputElement {
  const input = element("input", {
    type: "color",
    name,
    "aria-label": label,
    input: () => report(linearColour(input.value)),
  });
  return input;
}

/** Radiance as a colour and a strength, each of which stays while the other makes it dark. */
function createEmissionRows(patch: Patch): MaterialRows {
  let name = "";
  let shown: Emission = { colour: [1, 1, 1], strength: 1 };
  const colour = colourInput("emissive", "Emission colour", (picked) =>
    patch({ emissive: radianceOf(picked, shown.strength || 1) }),
  );
  const strength = createSliderRow(
    {
      label: "Emission",
      description: "Radiance that the surface sends out by itself. A factor on the texture.",
      unit: "",
      minimum: 0,
      maximum: 1000,
      scale: "cubic",
    },
    (value) => patch({ emissive: radianceOf(shown.colour, value) }),
  );
  const show = (material: MaterialInfo): void => {
    const now = emissionOf(material.emissive);
    if (now.strength > 0 || material.name !== name) shown = now;
    name = material.name;
    colour.value = displayColour(shown.colour);
    strength.show(now.strength);
  };
  return { nodes: [field("Emission colour", colour), strength.node], show };
}

/** Rays go by the file's, which is why it cannot be changed. */
function createCutoff(): MaterialRows {
  const node = element("p", { class: "facts" });
  const show = ({ alpha_cutoff: cutoff }: MaterialInfo): void => {
    node.hidden = cutoff === undefined;
    setText(node, cutoff === undefined ? "" : `Holes where the opacity is below ${cutoff}`);
  };
  return { nodes: [node], show };
}
