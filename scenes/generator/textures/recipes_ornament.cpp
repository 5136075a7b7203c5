#include <array>
#include <cmath>
#include <string_view>

#include "scenes/generator/geometry/transforms.hpp"
#include "scenes/generator/textures/noise.hpp"
#include "scenes/generator/textures/recipe_tools.hpp"
#include "scenes/generator/textures/recipes.hpp"

namespace heliograph::scenes::recipes {
namespace {

const glm::vec3 gilding(1.00f, 0.84f, 0.55f);
const glm::vec3 lapis(0.075f, 0.125f, 0.30f);

// 1 inside a star with `rays` points, softened over `softness`.
float star(glm::vec2 offset, float outer, float inner, int rays, float softness) {
  const float angle = std::atan2(offset.x, -offset.y);
  const float sector = two_pi / float(rays);
  const float folded = std::abs(angle - sector * std::round(angle / sector)) / (0.5f * sector);
  // Straight edges between a tip (folded = 0) and a notch (folded = 1).
  const glm::vec2 tip(outer, 0.0f);
  const glm::vec2 notch(inner * std::cos(0.5f * sector), inner * std::sin(0.5f * sector));
  const float radius = glm::length(offset);
  const glm::vec2 point =
      radius * glm::vec2(std::cos(folded * 0.5f * sector), std::sin(folded * 0.5f * sector));
  const glm::vec2 edge = glm::normalize(notch - tip);
  const float distance = glm::dot(point - tip, glm::vec2(-edge.y, edge.x));
  return smooth_step(-softness, softness, distance);
}

float ring(float radius, float middle, float half_width, float softness) {
  return smooth_step(half_width + softness, half_width - softness, std::abs(radius - middle));
}

// Leaf gold over a painted ground: metallic where `cover` is, a little thicker than the paint.
void gild(SurfaceSample& s, float cover, float wear) {
  const float kept = cover * smooth_step(-0.75f, -0.45f, wear);
  s.color = blend(s.color, gilding * (0.93f + 0.07f * wear), kept);
  s.metallic = std::max(s.metallic, kept);
  s.roughness = glm::mix(s.roughness, 0.28f + 0.06f * wear, kept);
  s.height += 0.0010f * kept;
}

}  // namespace

TextureRecipe star_vault() {
  const auto sample = [](glm::vec2 uv) {
    const float cloud = fractal_noise(uv, {2, 2}, 5, 501);
    const float brush = fractal_noise(uv, {9, 12}, 3, 511);
    const float wear = fractal_noise(uv, {10, 10}, 3, 521);
    SurfaceSample s;
    s.color = lapis * (1.0f + 0.22f * cloud + 0.08f * brush);
    s.roughness = 0.82f + 0.05f * brush;
    s.height = 0.0008f * brush;
    float cover = 0.0f;
    for (const glm::vec2 center : {glm::vec2(0.25f, 0.25f), glm::vec2(0.75f, 0.75f)}) {
      cover = std::max(cover, star(wrapped_offset(center, uv), 0.135f, 0.05f, 8, 0.003f));
    }
    for (const glm::vec2 center : {glm::vec2(0.75f, 0.25f), glm::vec2(0.25f, 0.75f)}) {
      cover = std::max(cover, star(wrapped_offset(center, uv), 0.06f, 0.024f, 6, 0.003f));
    }
    gild(s, cover, wear);
    return s;
  };
  return {"star_vault", 1.1f, 1, false, sample};
}

TextureRecipe meander_frieze() {
  const auto sample = [](glm::vec2 uv) {
    // One running key: the bottom line joins each spiral to the next.
    constexpr std::array<std::string_view, 7> key = {" #######", " #     #", " # ### #", " # #   #",
                                                     " # #####", " #      ", "########"};
    constexpr float keys = 4.0f;
    const float wear = fractal_noise(uv, {12, 12}, 3, 601);
    const float brush = fractal_noise(uv, {6, 6}, 4, 611);
    SurfaceSample s;
    s.color = glm::vec3(0.36f, 0.085f, 0.065f) * (1.0f + 0.15f * brush);
    s.roughness = 0.72f + 0.06f * brush;
    // The key fills one band of a quarter tile; the rest is stripes.
    const float in_repeat = uv.y * keys - std::floor(uv.y * keys);
    const float x = (uv.x * keys - std::floor(uv.x * keys)) * 8.0f;
    const float y = (in_repeat - 0.2f) / 0.6f * 7.0f;
    float cover = 0.0f;
    if (y >= 0.0f && y < 7.0f) cover = key[std::size_t(y)][std::size_t(x) % 8] == '#' ? 1.0f : 0.0f;
    const float from_middle = std::abs(in_repeat - 0.5f);
    cover = std::max(cover, ring(from_middle, 0.39f, 0.022f, 0.004f));
    if (from_middle > 0.43f) s.color = lapis * (1.15f + 0.2f * brush);
    gild(s, cover, wear);
    return s;
  };
  return {"meander_frieze", 2.0f, 1, false, sample};
}

TextureRecipe mosaic() {
  const auto sample = [](glm::vec2 uv) {
    constexpr int tesserae = 36;
    const Block block = block_at(uv, tesserae, tesserae, 0.0f);
    const glm::vec2 middle = (glm::vec2(block.column, block.row) + 0.5f) / float(tesserae);
    const float grout =
        1.0f -
        smooth_step(0.05f, 0.14f,
                    std::min({block.local.x, 1 - block.local.x, block.local.y, 1 - block.local.y}));
    const float tone = hash_unit(block.column, block.row, 701);
    const float wave = middle.y * 6.0f + 0.35f * std::sin(two_pi * middle.x * 2.0f);
    const int band = int(std::floor(wave + 3.0f)) % 3;  // the wave dips below 0
    const std::array<glm::vec3, 3> palette = {glm::vec3(0.05f, 0.24f, 0.36f),
                                              glm::vec3(0.13f, 0.46f, 0.50f),
                                              glm::vec3(0.70f, 0.76f, 0.68f)};
    SurfaceSample s;
    s.color = palette[std::size_t(band)] * (0.78f + 0.44f * tone);
    s.roughness = 0.22f + 0.15f * tone;
    if (tone > 0.94f) {
      s.color = gilding;
      s.metallic = 1.0f;
    }
    s.color = blend(s.color, glm::vec3(0.52f, 0.49f, 0.44f), grout);
    s.metallic *= 1.0f - grout;
    s.roughness = glm::mix(s.roughness, 0.9f, grout);
    s.height = -0.003f * grout + 0.0015f * tone;
    return s;
  };
  return {"mosaic", 1.0f, 1, false, sample};
}

TextureRecipe majolica() {
  const auto sample = [](glm::vec2 uv) {
    const float pool = fractal_noise(uv, {4, 4}, 4, 801);
    const glm::vec3 white(0.90f, 0.88f, 0.83f);
    const glm::vec3 blue(0.08f, 0.17f, 0.46f);
    const glm::vec3 ochre(0.80f, 0.52f, 0.14f);
    const glm::vec2 cell = uv * 4.0f;
    const glm::vec2 local = cell - glm::floor(cell) - 0.5f;
    const float radius = glm::length(local);
    const float angle = std::atan2(local.y, local.x);
    const float petal_edge = 0.16f + 0.16f * std::abs(std::cos(2.5f * angle));
    const float petals = smooth_step(petal_edge + 0.02f, petal_edge - 0.02f, radius);
    const float heart = smooth_step(0.10f, 0.07f, radius);
    const float stripes = ring(std::abs(local.y), 0.46f, 0.018f, 0.006f);
    const float vine =
        ring(std::abs(local.y - 0.38f * std::sin(two_pi * cell.x * 0.5f)), 0.0f, 0.016f, 0.010f);
    SurfaceSample s;
    s.color = blend(white, blue * (1.0f + 0.5f * pool), std::max({petals, stripes, 0.7f * vine}));
    s.color = blend(s.color, ochre, heart);
    s.roughness = 0.10f + 0.03f * pool;
    s.height = 0.0002f * (petals - heart) + 0.0003f * pool;
    return s;
  };
  return {"majolica", 1.2f, 1, false, sample};
}

TextureRecipe painted_panel() {
  const auto sample = [](glm::vec2 uv) {
    const float brush = fractal_noise(uv, {5, 5}, 5, 901);
    const float wear = fractal_noise(uv, {14, 14}, 3, 911);
    const glm::vec2 local = uv - 0.5f;
    const float radius = glm::length(local);
    const float angle = std::atan2(local.y, local.x);
    const float border = std::max(std::abs(local.x), std::abs(local.y));
    const float rosette_edge = 0.17f + 0.045f * std::cos(8.0f * angle);
    const float outer_edge = 0.30f + 0.03f * std::cos(16.0f * angle);
    SurfaceSample s;
    s.color = glm::vec3(0.10f, 0.26f, 0.22f) * (1.0f + 0.2f * brush);
    s.color = blend(s.color, glm::vec3(0.42f, 0.10f, 0.075f) * (1.0f + 0.15f * brush),
                    smooth_step(outer_edge + 0.01f, outer_edge - 0.01f, radius));
    s.roughness = 0.7f + 0.06f * brush;
    float cover = smooth_step(rosette_edge + 0.008f, rosette_edge - 0.008f, radius);
    cover -= ring(radius, 0.075f, 0.012f, 0.006f);
    cover = std::max(cover, ring(radius, outer_edge, 0.008f, 0.004f));
    cover = std::max(cover, ring(border, 0.44f, 0.012f, 0.004f));
    gild(s, std::clamp(cover, 0.0f, 1.0f), wear);
    return s;
  };
  return {"painted_panel", 1.0f, 1, false, sample};
}

TextureRecipe stencilled_fresco() {
  const auto sample = [](glm::vec2 uv) {
    const float cloud = fractal_noise(uv, {3, 3}, 5, 951);
    const float wear = fractal_noise(uv, {10, 10}, 3, 961);
    // A lozenge net with a quatrefoil in every mesh.
    const glm::vec2 turned(4.0f * (uv.x + uv.y), 4.0f * (uv.x - uv.y));
    const glm::vec2 local = turned - glm::floor(turned) - 0.5f;
    const float net = std::max(std::abs(local.x), std::abs(local.y));
    const glm::vec2 lobe = glm::abs(local) - 0.10f;
    const float foil = std::min(glm::length(lobe), glm::length(local) + 0.03f);
    const float line = smooth_step(0.455f, 0.47f, net);
    const float quatrefoil = smooth_step(0.135f, 0.115f, foil);
    SurfaceSample s;
    s.color = glm::vec3(0.36f, 0.52f, 0.50f) * (1.0f + 0.16f * cloud);
    s.color = blend(s.color, glm::vec3(0.62f, 0.66f, 0.55f), 0.75f * line);
    s.roughness = 0.8f + 0.05f * cloud;
    s.height = 0.0006f * cloud;
    gild(s, quatrefoil, wear);
    s.color = blend(s.color, glm::vec3(0.50f, 0.14f, 0.10f),
                    smooth_step(0.055f, 0.04f, glm::length(local)));
    return s;
  };
  return {"stencilled_fresco", 1.4f, 1, false, sample};
}

}  // namespace heliograph::scenes::recipes
