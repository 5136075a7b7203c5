// Interference in a film on a surface, thinner than a few wavelengths of light
// (KHR_materials_iridescence; Belcour and Barla 2017).
#ifndef HELIOGRAPH_THIN_FILM_GLSL
#define HELIOGRAPH_THIN_FILM_GLSL
#include "lib/lighting/brdf.glsl"

struct ThinFilm {
  float share;      // of the surface that it covers
  float ior;        // its index of refraction
  float thickness;  // nanometres
};

/// Reflectance of a boundary at normal incidence.
float boundary_reflectance(float inside, float outside) {
  float ratio = (inside - outside) / (inside + outside);
  return ratio * ratio;
}
vec3 boundary_reflectance(vec3 inside, float outside) {
  vec3 ratio = (inside - outside) / (inside + outside);
  return ratio * ratio;
}

/// The index of refraction that reflects so much at normal incidence to air.
vec3 index_of_reflectance(vec3 f0) {
  vec3 root = sqrt(clamp(f0, 0.0, 0.9999));
  return (1.0 + root) / (1.0 - root);
}

/// What the eye's red, green and blue see of cos(2 pi path / wavelength + shift), over all
/// wavelengths; `path` in nanometres. Sums of Gaussians that are fitted to the curves of CIE 1931
/// (paper, equation 10), whose transforms are known.
vec3 interference(float path, vec3 shift) {
  // Beyond a hundred micrometres nothing is left of the fringes.
  float phase = 2.0 * pi * min(path, 1e5);
  vec3 fringe = vec3(0.84659, 1.00022, 1.00112) *
                cos(vec3(1.6810e-3, 1.7953e-3, 2.2084e-3) * phase + shift) *
                exp(-vec3(4.3278e-9, 9.3046e-9, 6.6121e-9) * phase * phase);
  // X has a second peak.
  fringe.x += 0.15387 * cos(2.2399e-3 * phase + shift.x) * exp(-4.5282e-9 * phase * phase);
  return vec3(dot(vec3(3.2404542, -1.5371385, -0.4985314), fringe),
              dot(vec3(-0.9692660, 1.8760108, 0.0415560), fringe),
              dot(vec3(0.0556434, -0.2040259, 1.0572252), fringe));
}

/// What film and base of normal reflectance `f0` reflect together of light from air that meets them
/// at this cosine: all orders of interference up to the second.
vec3 film_reflectance(ThinFilm film, float cosine, vec3 f0) {
  // A film that is too thin to matter is air.
  float ior = mix(1.0, film.ior, smoothstep(0.0, 0.03, film.thickness));
  float within = 1.0 - (1.0 - cosine * cosine) / (ior * ior);  // squared cosine inside of the film
  float cosine_within = sqrt(max(within, 0.0));
  float first = mix(boundary_reflectance(ior, 1.0), 1.0, schlick_weight(cosine));
  float passed = 1.0 - first;
  vec3 base_ior = index_of_reflectance(f0);
  vec3 second = mix(boundary_reflectance(base_ior, ior), vec3(1.0), schlick_weight(cosine_within));
  // Where the film is denser than the base only the first reflection turns by half a wave. Another
  // half is that of the terms of `order`, which are negative.
  vec3 shift = pi + pi * vec3(lessThan(base_ior, vec3(ior)));
  vec3 both = clamp(first * second, 1e-5, 0.9999);
  vec3 returned = passed * passed * second / (1.0 - both);
  vec3 sum = first + returned;
  vec3 order = (returned - passed) * sqrt(both);
  float path = 2.0 * ior * film.thickness * cosine_within;
  sum += 2.0 * order * interference(path, shift);
  order *= sqrt(both);
  sum += 2.0 * order * interference(2.0 * path, 2.0 * shift);
  return clamp(sum, 0.0, 1.0);
}

/// The reflectance at normal incidence of a surface under a film, whose reflectance at `cosine` is
/// by Schlick's approximation what the film makes of it.
vec3 filmed_f0(ThinFilm film, float cosine, vec3 f0) {
  float weight = min(schlick_weight(cosine), 0.9999);
  vec3 seen = film_reflectance(film, cosine, f0);
  return mix(f0, clamp((seen - weight) / (1.0 - weight), 0.0, 1.0), film.share);
}

/// The film over a point that is seen at `cosine`: over its dielectric, whose reflectance is the
/// layer's, and over its metal, whose reflectance is the base colour.
void add_film(ThinFilm film, float cosine, float metallic, inout SurfaceLayer layer,
              inout vec3 base_color) {
  if (film.share <= 0.0) return;
  layer.f0 = layer.f90 * filmed_f0(film, cosine, layer.f0 / max(layer.f90, 1e-6));
  base_color = mix(base_color, filmed_f0(film, cosine, base_color), metallic);
}

#endif
