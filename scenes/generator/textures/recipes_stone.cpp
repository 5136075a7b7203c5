#include <cmath>

#include "scenes/generator/textures/noise.hpp"
#include "scenes/generator/textures/recipe_tools.hpp"
#include "scenes/generator/textures/recipes.hpp"

namespace heliograph::scenes::recipes {
namespace {

// Fine grain and small pits, metres.
float weathered(glm::vec2 uv, glm::ivec2 cells, std::uint32_t seed) {
  const Cell pits = cellular_noise(uv, cells, seed);
  const float pit = pits.identity < 0.35f ? smooth_step(0.35f, 0.1f, pits.nearest) : 0.0f;
  return 0.0008f * fractal_noise(uv, cells / 2, 3, seed + 5) - 0.0022f * pit;
}

}  // namespace

TextureRecipe marble(const MarbleLook& look, float width) {
  const auto sample = [look](glm::vec2 uv) {
    const std::uint32_t seed = look.seed * 977u;
    const glm::vec2 warp(fractal_noise(uv, {3, 3}, 4, seed),
                         fractal_noise(uv, {3, 3}, 4, seed + 7));
    const glm::vec2 p = uv + 0.07f * warp;
    const float broad = std::pow(ridge_noise(p, {2, 3}, 4, seed + 13), 16.0f);
    const float thin = std::pow(ridge_noise(p, {5, 4}, 4, seed + 31), 26.0f);
    const float vein = std::min(1.0f, look.vein_amount * (broad + 0.6f * thin));
    const float cloud = 0.5f + 0.6f * fractal_noise(p, {2, 2}, 5, seed + 50);
    const float smudge = fractal_noise(uv, {4, 4}, 3, seed + 90);
    SurfaceSample s;
    s.color = blend(blend(look.ground, look.cloud, 0.75f * cloud), look.vein, vein);
    s.roughness = std::clamp(look.roughness * (1.0f + 0.22f * smudge) + 0.05f * vein, 0.03f, 1.0f);
    s.height = -0.00012f * vein + 0.00006f * smudge;
    return s;
  };
  return {look.name, width, 1, false, sample};
}

TextureRecipe ashlar(const std::string& name, glm::vec3 color, std::uint32_t seed) {
  constexpr float width = 2.4f;
  const auto sample = [color, seed](glm::vec2 uv) {
    const Block block = block_at(uv, 2, 6);
    const float edge =
        block.edge_distance * width + 0.0035f * fractal_noise(uv, {24, 24}, 2, seed + 3);
    const float joint = 1.0f - smooth_step(0.002f, 0.008f, edge);
    const float tone = hash_unit(block.column, block.row, seed) - 0.5f;
    const float stain = fractal_noise(uv, {3, 4}, 5, seed + 11);
    const float grain = fractal_noise(uv, {40, 60}, 2, seed + 21);
    SurfaceSample s;
    s.color = color * (1.0f + 0.12f * tone + 0.06f * stain + 0.025f * grain);
    s.color += glm::vec3(0.02f, 0.005f, -0.015f) * (tone + stain);
    s.color = blend(s.color, color * glm::vec3(0.82f, 0.80f, 0.77f), 0.8f * joint);
    s.height = -0.007f * joint + weathered(uv, {64, 64}, seed + 31) +
               0.004f * smooth_step(0.0f, 0.03f, edge) + 0.002f * tone;
    s.roughness = 0.78f + 0.08f * stain + 0.12f * joint;
    return s;
  };
  return {name, width, 1, false, sample};
}

TextureRecipe smooth_limestone(const std::string& name, glm::vec3 color, std::uint32_t seed) {
  const auto sample = [color, seed](glm::vec2 uv) {
    const glm::vec2 p = uv + 0.03f * glm::vec2(fractal_noise(uv, {4, 4}, 3, seed),
                                               fractal_noise(uv, {4, 4}, 3, seed + 9));
    const float bedding = fractal_noise(p, {3, 14}, 4, seed + 17);
    const float stain = fractal_noise(uv, {3, 3}, 5, seed + 27);
    const Cell shells = cellular_noise(p, {26, 26}, seed + 37);
    const float shell = shells.identity < 0.25f ? smooth_step(0.4f, 0.15f, shells.nearest) : 0.0f;
    SurfaceSample s;
    s.color = color * (1.0f + 0.05f * bedding + 0.05f * stain) +
              glm::vec3(0.018f, 0.006f, -0.014f) * stain;
    s.color = blend(s.color, color * 1.07f, 0.35f * shell);
    s.height = weathered(uv, {48, 48}, seed + 41) * 0.5f;
    s.roughness = 0.62f + 0.08f * stain - 0.06f * shell;
    return s;
  };
  return {name, 1.5f, 1, false, sample};
}

TextureRecipe plaster(const std::string& name, glm::vec3 color, std::uint32_t seed) {
  const auto sample = [color, seed](glm::vec2 uv) {
    const float cloud = fractal_noise(uv, {2, 2}, 6, seed);
    const float trowel =
        fractal_noise(uv + 0.04f * fractal_noise(uv, {3, 3}, 2, seed + 3), {7, 12}, 4, seed + 9);
    const float crack_zone = smooth_step(0.1f, 0.6f, fractal_noise(uv, {2, 2}, 3, seed + 19));
    const float crack =
        crack_zone * smooth_step(0.985f, 0.998f, ridge_noise(uv, {5, 5}, 4, seed + 29));
    SurfaceSample s;
    s.color = color * (1.0f + 0.08f * cloud + 0.025f * trowel);
    s.color += glm::vec3(0.012f, 0.0f, -0.012f) * cloud;
    s.color = blend(s.color, color * 0.72f, 0.7f * crack);
    s.height = 0.0022f * trowel - 0.002f * crack;
    s.roughness = 0.86f + 0.05f * trowel;
    return s;
  };
  return {name, 3.0f, 1, false, sample};
}

TextureRecipe brick() {
  constexpr float width = 1.2f;
  const auto sample = [](glm::vec2 uv) {
    const Block block = block_at(uv, 5, 16);
    const float edge = block.edge_distance * width + 0.003f * fractal_noise(uv, {30, 30}, 2, 402);
    const float mortar = 1.0f - smooth_step(0.003f, 0.008f, edge);
    const float tone = hash_unit(block.column, block.row, 401);
    const float burn = hash_unit(block.column, block.row, 411);
    const float grain = fractal_noise(uv, {40, 40}, 3, 421);
    const glm::vec3 red(0.62f, 0.36f, 0.26f);
    const glm::vec3 pale(0.74f, 0.54f, 0.40f);
    const glm::vec3 dark(0.44f, 0.28f, 0.24f);
    SurfaceSample s;
    s.color = blend(blend(red, pale, tone), dark, burn > 0.85f ? 0.7f : 0.0f);
    s.color *= 1.0f + 0.10f * grain;
    s.color = blend(s.color, glm::vec3(0.76f, 0.71f, 0.63f) * (1.0f + 0.06f * grain), mortar);
    s.height = -0.006f * mortar + 0.0012f * grain + 0.002f * tone;
    s.roughness = 0.84f + 0.1f * mortar;
    return s;
  };
  return {"brick", width, 1, false, sample};
}

TextureRecipe terracotta(const std::string& name, glm::vec3 color, std::uint32_t seed) {
  const auto sample = [color, seed](glm::vec2 uv) {
    const float fire = fractal_noise(uv, {3, 3}, 5, seed);
    const float grain = fractal_noise(uv, {32, 32}, 3, seed + 9);
    const float turned = std::sin(6.2831853f * (20.0f * uv.y + 0.4f * fire));
    const float lime = smooth_step(0.35f, 0.9f, fractal_noise(uv, {4, 4}, 4, seed + 19));
    SurfaceSample s;
    s.color = color * (1.0f + 0.14f * fire + 0.06f * grain);
    s.color = blend(s.color, glm::vec3(0.80f, 0.72f, 0.62f), 0.35f * lime);
    s.height = 0.0005f * turned + 0.0008f * grain;
    s.roughness = 0.8f + 0.08f * lime;
    return s;
  };
  return {name, 1.0f, 2, false, sample};
}

}  // namespace heliograph::scenes::recipes
