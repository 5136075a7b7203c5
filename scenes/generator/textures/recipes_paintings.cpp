#include <algorithm>
#include <cmath>

#include "scenes/generator/textures/noise.hpp"
#include "scenes/generator/textures/recipe_tools.hpp"
#include "scenes/generator/textures/recipes.hpp"

namespace heliograph::scenes::recipes {
namespace {

// Strokes of a brush: a height field that colours are pushed about with.
float strokes(glm::vec2 uv, std::uint32_t seed) {
  const glm::vec2 bent = uv + 0.03f * glm::vec2(fractal_noise(uv, {3, 3}, 2, seed),
                                                fractal_noise(uv, {3, 3}, 2, seed + 3));
  return fractal_noise(bent, {12, 40}, 3, seed + 7);
}

glm::vec3 hills(glm::vec2 p, float brush) {
  glm::vec3 color =
      blend(glm::vec3(0.94f, 0.80f, 0.58f), glm::vec3(0.36f, 0.56f, 0.76f), 1.15f - 1.6f * p.y);
  const float sun = glm::distance(p, glm::vec2(0.68f, 0.40f));
  color = blend(color, glm::vec3(1.0f, 0.93f, 0.72f), smooth_step(0.085f, 0.07f, sun));
  const glm::vec3 tones[4] = {
      {0.50f, 0.58f, 0.66f}, {0.36f, 0.48f, 0.48f}, {0.30f, 0.42f, 0.26f}, {0.44f, 0.46f, 0.16f}};
  for (int ridge = 0; ridge < 4; ++ridge) {
    const float k = float(ridge);
    const float crest = 0.46f + 0.12f * k +
                        0.07f * std::sin(6.3f * (p.x * (1.0f + 0.3f * k) + 0.27f * k * k)) +
                        0.02f * std::sin(17.0f * p.x + 2.0f * k);
    color = blend(color, tones[ridge], smooth_step(crest - 0.006f, crest + 0.006f, p.y));
  }
  return color * (1.0f + 0.16f * brush);
}

glm::vec3 lemons(glm::vec2 p, float brush) {
  glm::vec3 color = blend(glm::vec3(0.13f, 0.20f, 0.24f), glm::vec3(0.24f, 0.30f, 0.30f), p.x);
  color = blend(color, glm::vec3(0.56f, 0.38f, 0.24f), smooth_step(0.66f, 0.68f, p.y));
  const auto dish = glm::length((p - glm::vec2(0.5f, 0.70f)) * glm::vec2(1.0f, 3.2f));
  color = blend(color, glm::vec3(0.80f, 0.84f, 0.86f), smooth_step(0.36f, 0.35f, dish));
  color = blend(color, glm::vec3(0.22f, 0.36f, 0.60f),
                smooth_step(0.015f, 0.008f, std::abs(dish - 0.31f)));
  const glm::vec2 fruits[4] = {{0.36f, 0.60f}, {0.52f, 0.62f}, {0.65f, 0.58f}, {0.48f, 0.50f}};
  for (const glm::vec2 fruit : fruits) {
    const glm::vec2 offset = (p - fruit) * glm::vec2(1.0f, 1.25f);
    const float light = 0.62f - 3.0f * (offset.x + offset.y);
    color =
        blend(color, blend(glm::vec3(0.62f, 0.40f, 0.06f), glm::vec3(1.0f, 0.86f, 0.32f), light),
              smooth_step(0.105f, 0.100f, glm::length(offset)));
  }
  return color * (1.0f + 0.13f * brush);
}

glm::vec3 fields(glm::vec2 p, float brush) {
  // Rectangles of colour in the manner of a concrete painting.
  const glm::vec2 cuts(0.34f, 0.58f);
  glm::vec3 color = p.x < cuts.x ? glm::vec3(0.78f, 0.22f, 0.14f) : glm::vec3(0.93f, 0.87f, 0.74f);
  if (p.x >= cuts.x && p.y > cuts.y) color = {0.12f, 0.26f, 0.48f};
  if (p.x < cuts.x && p.y > 0.78f) color = {0.90f, 0.66f, 0.18f};
  if (p.x > 0.76f && p.y < 0.26f) color = {0.14f, 0.40f, 0.34f};
  return color * (1.0f + 0.10f * brush);
}

}  // namespace

TextureRecipe painting(int subject) {
  const auto sample = [subject](glm::vec2 uv) {
    const float brush = strokes(uv, 2601 + std::uint32_t(subject));
    // Colours are laid down in strokes, so their borders are not quite straight.
    const glm::vec2 p = uv + 0.006f * brush;
    SurfaceSample s;
    s.color = subject == 0 ? hills(p, brush) : subject == 1 ? lemons(p, brush) : fields(p, brush);
    s.roughness = 0.48f + 0.12f * brush;
    s.height = 0.0007f * brush;
    return s;
  };
  static constexpr const char* names[] = {"painting_hills", "painting_lemons", "painting_fields"};
  return {names[subject], 1.0f, 1, false, sample};
}

}  // namespace heliograph::scenes::recipes
