#include <cmath>

#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/textures/noise.hpp"
#include "scenes/generator/textures/recipe_tools.hpp"
#include "scenes/generator/textures/recipes.hpp"

namespace heliograph::scenes::recipes {
namespace {}  // namespace

TextureRecipe wood(const std::string& name, glm::vec3 light, glm::vec3 dark, std::uint32_t seed) {
  const auto sample = [light, dark, seed](glm::vec2 uv) {
    constexpr int planks = 6;
    const Block plank = block_at(uv, 1, planks, 0.37f);
    const float shade = hash_unit(plank.column, plank.row, seed);
    const float bow = 0.04f * fractal_noise(uv, {2, 4}, 3, seed + 3 + std::uint32_t(plank.row));
    const glm::vec2 p = uv + glm::vec2(0.0f, bow);
    const float grain = fractal_noise(p, {4, 72}, 3, seed + 11);
    const float rings = 0.5f + 0.5f * std::sin(two_pi * (24.0f * p.y + 1.5f * shade + grain));
    const float gap = 1.0f - smooth_step(0.002f, 0.006f, plank.edge_distance);
    SurfaceSample s;
    s.color = blend(dark, light, 0.35f + 0.3f * rings + 0.3f * (shade - 0.5f) + 0.25f * grain);
    s.color = blend(s.color, dark * 0.35f, gap);
    s.height = -0.004f * gap + 0.0006f * rings + 0.0006f * grain;
    s.roughness = 0.52f + 0.12f * grain + 0.3f * gap;
    return s;
  };
  return {name, 1.2f, 1, false, sample};
}

TextureRecipe patinated_metal(const std::string& name, glm::vec3 metal, glm::vec3 patina,
                              float patina_amount, float roughness, std::uint32_t seed) {
  const auto sample = [=](glm::vec2 uv) {
    const float cloud = fractal_noise(uv, {4, 4}, 5, seed);
    const float scratch = fractal_noise(uv, {48, 6}, 2, seed + 9);
    const float cover = patina_amount * smooth_step(-0.1f, 0.55f, cloud);
    SurfaceSample s;
    s.color = blend(metal * (1.0f + 0.06f * scratch), patina, cover);
    s.metallic = 1.0f - cover;
    s.roughness = glm::mix(roughness + 0.05f * scratch + 0.05f * cloud, 0.8f, cover);
    s.height = 0.0003f * cover + 0.0003f * cloud;
    return s;
  };
  return {name, 0.6f, 2, false, sample};
}

TextureRecipe gold() {
  const auto sample = [](glm::vec2 uv) {
    const Cell hammer = cellular_noise(uv, {12, 12}, 1101, 0.8f);
    const float smudge = fractal_noise(uv, {3, 3}, 4, 1111);
    SurfaceSample s;
    s.color = glm::vec3(1.0f, 0.86f, 0.57f) * (0.97f + 0.03f * smudge);
    s.metallic = 1.0f;
    s.roughness = 0.17f + 0.05f * smudge;
    s.height = 0.0006f * hammer.nearest * hammer.nearest;
    return s;
  };
  return {"gold", 0.5f, 2, false, sample};
}

TextureRecipe damask(const std::string& name, glm::vec3 cloth, glm::vec3 motif) {
  const auto sample = [cloth, motif](glm::vec2 uv) {
    const float weave = std::sin(two_pi * 64.0f * uv.x) * std::sin(two_pi * 64.0f * uv.y);
    const float fade = fractal_noise(uv, {2, 2}, 4, 1201);
    // Ogees: cells between mirrored waves, each with a palmette of nested leaves.
    const float wave = 0.25f + 0.17f * std::cos(two_pi * uv.y * 2.0f);
    const float fold = std::abs(uv.x * 2.0f - std::floor(uv.x * 2.0f) - 0.5f);
    const float lattice = smooth_step(0.035f, 0.015f, std::abs(fold - wave));
    const bool inner_cell = fold < wave;
    const glm::vec2 middle(0.5f * std::round(uv.x * 2.0f - 0.5f) + 0.25f,
                           0.5f * std::round(uv.y * 2.0f));
    const glm::vec2 other(0.5f * std::round(uv.x * 2.0f),
                          0.5f * std::round(uv.y * 2.0f - 0.5f) + 0.25f);
    const glm::vec2 offset = 2.0f * (uv - (inner_cell ? middle : other));
    const float radius = glm::length(offset * glm::vec2(1.25f, 0.85f));
    const float angle = std::atan2(offset.x, offset.y);
    const float petal = 0.19f + 0.06f * std::cos(6.0f * angle);
    const float flower = smooth_step(petal + 0.01f, petal - 0.01f, radius) -
                         smooth_step(0.10f, 0.085f, radius) + smooth_step(0.05f, 0.035f, radius);
    const float pattern = std::clamp(std::max(lattice, flower), 0.0f, 1.0f);
    SurfaceSample s;
    s.color = blend(cloth * (1.0f + 0.08f * fade), motif, 0.85f * pattern);
    s.color *= 1.0f + 0.05f * weave;
    s.height = 0.0002f * weave + 0.0005f * pattern;
    s.roughness = 0.86f - 0.3f * pattern;
    return s;
  };
  return {name, 0.8f, 1, false, sample};
}

TextureRecipe leaf() {
  const auto sample = [](glm::vec2 uv) {
    // The stalk is at the bottom of the tile; the blade is a slender lens with a wavy rim.
    const float along = 1.0f - uv.y;
    const float across = uv.x - 0.5f;
    const float rim = 0.40f *
                      std::pow(std::sin(3.14159265f * std::clamp(along, 0.0f, 1.0f)), 0.75f) *
                      (1.0f - 0.35f * along) * (1.0f + 0.05f * std::sin(two_pi * 9.0f * along));
    const float inside = rim - std::abs(across);
    const float rib = smooth_step(0.020f, 0.006f, std::abs(across));
    const float side = (std::abs(across) * 1.1f - along) * 11.0f;
    const float vein = smooth_step(0.16f, 0.04f, std::abs(side - std::round(side))) *
                       smooth_step(0.0f, 0.05f, inside);
    const float tone = fractal_noise(uv, {4, 4}, 4, 1301);
    SurfaceSample s;
    s.color = blend(glm::vec3(0.19f, 0.34f, 0.11f), glm::vec3(0.36f, 0.50f, 0.16f),
                    0.5f + 0.5f * tone + 0.25f * along);
    s.color = blend(s.color, glm::vec3(0.55f, 0.62f, 0.30f), std::max(0.8f * rib, 0.4f * vein));
    s.height = 0.002f * rib + 0.0012f * vein;
    s.roughness = 0.42f + 0.08f * tone;
    s.alpha = smooth_step(-0.006f, 0.006f, inside);
    return s;
  };
  return {"leaf", 1.0f, 2, true, sample};
}

TextureRecipe soil() {
  const auto sample = [](glm::vec2 uv) {
    const Cell clod = cellular_noise(uv, {14, 14}, 1401);
    const float grain = fractal_noise(uv, {16, 16}, 3, 1411);
    SurfaceSample s;
    s.color = glm::vec3(0.23f, 0.16f, 0.11f) * (0.8f + 0.5f * clod.identity + 0.2f * grain);
    s.height = 0.012f * (1.0f - clod.nearest) + 0.004f * grain;
    s.roughness = 0.95f;
    return s;
  };
  return {"soil", 0.5f, 4, false, sample};
}

TextureRecipe water() {
  const auto sample = [](glm::vec2 uv) {
    const glm::vec2 p = uv + 0.05f * glm::vec2(fractal_noise(uv, {3, 3}, 2, 1501),
                                               fractal_noise(uv, {3, 3}, 2, 1511));
    SurfaceSample s;
    s.color = glm::vec3(0.10f, 0.22f, 0.23f);
    s.height = 0.0035f * fractal_noise(p, {3, 4}, 3, 1521, 0.4f);
    s.roughness = 0.02f;
    return s;
  };
  return {"water", 2.0f, 1, false, sample};
}

}  // namespace heliograph::scenes::recipes
