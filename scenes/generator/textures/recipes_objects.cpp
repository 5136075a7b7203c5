#include <algorithm>
#include <cmath>

#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/textures/noise.hpp"
#include "scenes/generator/textures/recipe_tools.hpp"
#include "scenes/generator/textures/recipes.hpp"

namespace heliograph::scenes::recipes {
namespace {

// 1 on the lines between `count` x `count` tiles, `half_width` wide to both sides (in repeats).
float joints(glm::vec2 uv, int count, float half_width) {
  const glm::vec2 cell = uv * float(count);
  const glm::vec2 to_line = glm::abs(cell - glm::round(cell)) / float(count);
  return 1.0f - smooth_step(0.6f * half_width, 1.4f * half_width, std::min(to_line.x, to_line.y));
}

}  // namespace

TextureRecipe checker(const std::string& name, glm::vec3 light, glm::vec3 dark, int squares,
                      float width) {
  const auto sample = [=](glm::vec2 uv) {
    const glm::ivec2 cell = glm::ivec2(glm::floor(uv * float(squares)));
    const bool even = (cell.x + cell.y) % 2 == 0;
    const float tone = hash_unit(cell.x, cell.y, 2001) - 0.5f;
    const float cloud = fractal_noise(uv, {5, 5}, 4, 2011);
    const float joint = joints(uv, squares, 0.004f);
    SurfaceSample s;
    s.color = (even ? light : dark) * (1.0f + 0.05f * tone + 0.05f * cloud);
    s.color = blend(s.color, 0.5f * glm::min(light, dark), 0.8f * joint);
    s.roughness = 0.30f + 0.06f * cloud + 0.5f * joint;
    s.height = width * (0.0008f * tone - 0.003f * joint);
    return s;
  };
  return {name, width, 1, false, sample};
}

TextureRecipe metal_panels(const std::string& name, glm::vec3 metal, float roughness, float width) {
  const auto sample = [=](glm::vec2 uv) {
    constexpr int panels = 2;
    const glm::ivec2 cell = glm::ivec2(glm::floor(uv * float(panels)));
    const float tone = hash_unit(cell.x, cell.y, 2101) - 0.5f;
    const float haze = fractal_noise(uv, {3, 3}, 5, 2111);
    const float joint = joints(uv, panels, 0.0016f);
    SurfaceSample s;
    s.color = metal * (1.0f + 0.06f * tone + 0.03f * haze);
    s.color = blend(s.color, metal * 0.25f, joint);
    s.metallic = 1.0f;
    s.roughness = std::clamp(roughness * (1.0f + 0.25f * haze + 0.3f * tone), 0.02f, 1.0f);
    s.height = width * (0.00010f * haze - 0.0012f * joint);
    return s;
  };
  return {name, width, 1, false, sample};
}

TextureRecipe lattice() {
  const auto sample = [](glm::vec2 uv) {
    // Strips woven at 45 degrees; each passes over and under its neighbours in turn.
    constexpr float strips = 4.0f;
    const glm::vec2 turned = strips * glm::vec2(uv.x + uv.y, uv.x - uv.y);
    const glm::vec2 local = glm::abs(turned - glm::round(turned));
    constexpr float half_width = 0.17f;
    const glm::ivec2 cell = glm::ivec2(glm::round(turned));
    const bool first_on_top = (cell.x + cell.y) % 2 == 0;
    const bool on_first = local.x < half_width && (first_on_top || local.y >= half_width);
    const float across = on_first ? local.x : local.y;
    const glm::vec2 along =
        on_first ? glm::vec2(uv.x * 40.0f, uv.y * 4.0f) : glm::vec2(uv.x * 4.0f, uv.y * 40.0f);
    const float grain = fractal_noise(uv, {24, 24}, 3, 2201);
    const float streak = std::sin(two_pi * (along.x + along.y) * 0.25f + 3.0f * grain);
    SurfaceSample s;
    s.color = glm::vec3(0.50f, 0.33f, 0.19f) * (1.0f + 0.14f * grain + 0.05f * streak);
    s.roughness = 0.6f + 0.1f * grain;
    s.height = 0.006f * std::sqrt(std::max(0.0f, 1.0f - across * across / 0.03f));
    s.alpha = smooth_step(half_width + 0.012f, half_width - 0.012f, std::min(local.x, local.y));
    return s;
  };
  return {"lattice", 1.0f, 1, true, sample};
}

TextureRecipe concrete_slabs(const std::string& name, glm::vec3 color, float width) {
  const auto sample = [=](glm::vec2 uv) {
    constexpr int slabs = 2;
    const glm::ivec2 cell = glm::ivec2(glm::floor(uv * float(slabs)));
    const float tone = hash_unit(cell.x, cell.y, 2301) - 0.5f;
    const float cloud = fractal_noise(uv, {3, 3}, 6, 2311);
    const float grain = fractal_noise(uv, {64, 64}, 2, 2321);
    const Cell pores = cellular_noise(uv, {44, 44}, 2331);
    const float pore = pores.identity < 0.16f ? smooth_step(0.28f, 0.10f, pores.nearest) : 0.0f;
    const float joint = joints(uv, slabs, 0.0022f);
    SurfaceSample s;
    s.color = color * (1.0f + 0.06f * tone + 0.09f * cloud + 0.04f * grain);
    s.color = blend(s.color, color * 0.55f, std::max(0.8f * joint, 0.5f * pore));
    s.roughness = 0.80f + 0.06f * cloud + 0.1f * joint;
    s.height = width * (0.0005f * tone - 0.0022f * joint - 0.0005f * pore + 0.00008f * grain);
    return s;
  };
  return {name, width, 1, false, sample};
}

TextureRecipe terrazzo(const std::string& name, glm::vec3 ground, std::uint32_t seed) {
  const auto sample = [=](glm::vec2 uv) {
    const Cell coarse = cellular_noise(uv, {18, 18}, seed);
    const Cell fine = cellular_noise(uv, {46, 46}, seed + 7);
    const float chip =
        smooth_step(0.10f, 0.16f, coarse.border) * (coarse.identity < 0.62f ? 1.0f : 0.0f);
    const float crumb = smooth_step(0.16f, 0.24f, fine.border) *
                        (fine.identity < 0.45f ? 1.0f : 0.0f) * (1.0f - chip);
    const float pick = std::fmod(coarse.identity * 7.3f + fine.identity * chip, 1.0f);
    const glm::vec3 chips = pick < 0.35f   ? glm::vec3(0.86f, 0.82f, 0.74f)
                            : pick < 0.6f  ? glm::vec3(0.62f, 0.36f, 0.26f)
                            : pick < 0.82f ? glm::vec3(0.30f, 0.31f, 0.32f)
                                           : glm::vec3(0.76f, 0.62f, 0.42f);
    const float smudge = fractal_noise(uv, {4, 4}, 4, seed + 13);
    SurfaceSample s;
    s.color = blend(ground, chips, 0.9f * chip);
    s.color = blend(s.color, ground * (fine.identity < 0.2f ? 0.55f : 1.18f), crumb);
    s.color *= 1.0f + 0.04f * smudge;
    s.roughness = 0.26f + 0.06f * smudge + 0.06f * (1.0f - chip);
    s.height = 0.00012f * chip;
    return s;
  };
  return {name, 1.6f, 1, false, sample};
}

TextureRecipe glazed(const std::string& name, glm::vec3 color, std::uint32_t seed) {
  const auto sample = [=](glm::vec2 uv) {
    const float pool = fractal_noise(uv, {4, 5}, 4, seed);
    const float speck = cellular_noise(uv, {40, 40}, seed + 5).nearest;
    const float craze = smooth_step(0.985f, 0.998f, ridge_noise(uv, {9, 9}, 3, seed + 9));
    SurfaceSample s;
    s.color = color * (1.0f + 0.14f * pool);
    s.color = blend(s.color, color * 0.55f, 0.35f * smooth_step(0.12f, 0.05f, speck));
    s.color = blend(s.color, color * 0.75f, 0.3f * craze);
    s.roughness = 0.16f + 0.04f * pool + 0.1f * craze;
    s.height = 0.0004f * pool - 0.0001f * craze;
    return s;
  };
  return {name, 0.6f, 2, false, sample};
}

TextureRecipe brushed_metal(const std::string& name, glm::vec3 metal, float roughness,
                            std::uint32_t seed) {
  const auto sample = [=](glm::vec2 uv) {
    const float stroke = fractal_noise(uv, {2, 96}, 3, seed);
    const float haze = fractal_noise(uv, {3, 3}, 4, seed + 9);
    SurfaceSample s;
    s.color = metal * (1.0f + 0.05f * stroke + 0.03f * haze);
    s.metallic = 1.0f;
    s.roughness = std::clamp(roughness * (1.0f + 0.3f * stroke + 0.2f * haze), 0.02f, 1.0f);
    s.height = 0.00004f * stroke;
    return s;
  };
  return {name, 0.4f, 2, false, sample};
}

TextureRecipe linen(const std::string& name, glm::vec3 cloth, glm::vec3 stripe) {
  const auto sample = [=](glm::vec2 uv) {
    constexpr float threads = 80.0f;
    const float warp = std::sin(two_pi * threads * uv.x);
    const float weft = std::sin(two_pi * threads * uv.y);
    const float slub = fractal_noise(uv, {60, 6}, 2, 2501) + fractal_noise(uv, {6, 60}, 2, 2511);
    const float band = std::abs(uv.x - 0.5f);
    const float striped = smooth_step(0.115f, 0.105f, std::abs(band - 0.36f)) *
                          (std::abs(band - 0.36f) > 0.07f || std::abs(band - 0.36f) < 0.05f);
    SurfaceSample s;
    s.color = blend(cloth, stripe, 0.85f * striped) * (1.0f + 0.05f * warp * weft + 0.07f * slub);
    s.height = 0.0003f * std::max(warp, weft) + 0.0001f * slub;
    s.roughness = 0.9f;
    return s;
  };
  return {name, 0.6f, 1, false, sample};
}

}  // namespace heliograph::scenes::recipes
