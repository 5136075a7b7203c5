// Light through glass: KHR_materials_transmission, KHR_materials_volume and
// KHR_materials_dispersion, by the path tracer and by the hybrid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using scene::MaterialLayers;

constexpr float slab_depth = 0.5f;  // metres
constexpr float slab_ior = 1.5f;
constexpr std::uint32_t slab_view = 64;  // pixels; one metre wide

shared::Material unlit(const glm::vec3& color) {
  shared::Material material = surface(color);
  material.flags |= shared::material_unlit;
  return material;
}

MaterialLayers volume(float thickness) {
  MaterialLayers layers;
  layers.transmission = 1.0f;
  layers.thickness = thickness;
  return layers;
}

/// Around the origin; `half`: its half extents.
std::uint32_t add_box(SceneBuilder& builder, const glm::vec3& half,
                      const shared::Material& material) {
  return builder.add_quads(box_sides(half), material);
}

/// A slab of glass, turned by 45 degrees about Y, before a wall that is black where x < 0 and
/// white where x > 0. Nothing else shines. Seen along -Z without perspective.
RendererRig slab_before_edge(const MaterialLayers& glass,
                             const glm::vec3& color = glm::vec3(1.0f)) {
  SceneBuilder builder;
  shared::Material clear = surface(color, 0.0f);
  clear.ior = slab_ior;
  const auto slab =
      add_box(builder, {2.0f, 2.0f, 0.5f * slab_depth}, builder.with_layers(clear, glass));
  builder.place(slab, glm::rotate(glm::mat4(1.0f), glm::quarter_pi<float>(), glm::vec3(0, 1, 0)));
  builder.place(
      builder.add_quad({{{-9, -9, -4}, {0, -9, -4}, {0, 9, -4}, {-9, 9, -4}}}, unlit({0, 0, 0})));
  builder.place(
      builder.add_quad({{{0, -9, -4}, {9, -9, -4}, {9, 9, -4}, {0, 9, -4}}}, unlit({1, 1, 1})));
  scene::Camera camera = look({0, 0, 6}, {0, 0, 0});
  camera.orthographic_height = 1.0f;
  return {builder.build(), scene::constant_environment(glm::vec3(0.0f)), camera, slab_view,
          slab_view};
}

/// How far the slab moves what is behind it, metres.
double lateral_shift(double ior) {
  const double sine = std::sin(glm::quarter_pi<double>());
  return slab_depth * sine * (1.0 - sine / std::sqrt(ior * ior - sine * sine));
}

/// What is seen of the wall: radiance of its white part, and where that begins, metres from the
/// middle; by colour.
struct SeenEdge {
  glm::dvec3 white{0.0};
  glm::dvec3 begins{0.0};
};

SeenEdge seen_edge(RendererRig& rig, const protocol::Settings& settings, const std::string& name) {
  const glm::dvec3 mean = mean_color(rig, settings, name, 64);
  const render::FloatImage radiance = rig.capture("accumulated");
  SeenEdge seen;
  constexpr std::uint32_t first = slab_view * 3 / 4;
  for (std::uint32_t y = 0; y < slab_view; ++y) {
    for (std::uint32_t x = first; x < slab_view; ++x) seen.white += rgb(radiance, x, y);
  }
  seen.white /= static_cast<double>(slab_view) * (slab_view - first);
  seen.begins = 0.5 - mean / seen.white;
  return seen;
}

protocol::Settings path_traced() {
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::full;
  return settings;
}

protocol::Settings hybrid_from(protocol::PrimaryVisibility source) {
  protocol::Settings settings = undenoised();
  settings.gbuffer.source = source;
  return settings;
}

/// With all reflections between both sides of the slab.
double slab_transmittance() {
  const double reflectance = 0.04 + 0.96 * std::pow(1.0 - std::cos(glm::quarter_pi<double>()), 5);
  return (1.0 - reflectance) / (1.0 + reflectance);
}

TEST(GlassInReference, SlabShiftsAndDimsByFresnel) {
  RendererRig rig = slab_before_edge(volume(slab_depth));
  const SeenEdge seen = seen_edge(rig, path_traced(), "slab_reference");
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen.begins[c], lateral_shift(slab_ior), 0.006) << "channel " << c;
    EXPECT_NEAR(seen.white[c], slab_transmittance(), 0.012) << "channel " << c;
  }
}

TEST(GlassInReference, ThinWallShiftsNothing) {
  RendererRig rig = slab_before_edge(volume(0.0f));
  const SeenEdge seen = seen_edge(rig, path_traced(), "thin_slab_reference");
  EXPECT_NEAR(seen.begins.y, 0.0, 0.006);
}

TEST(GlassInReference, VolumeAttenuatesByTravelledDistance) {
  MaterialLayers tinted = volume(0.01f);  // what the material says does not matter
  tinted.attenuation_distance = 1.0f;
  tinted.attenuation_color = {0.9f, 0.5f, 0.2f};
  RendererRig rig = slab_before_edge(tinted);
  const SeenEdge seen = seen_edge(rig, path_traced(), "tinted_slab_reference");
  const double sine = std::sin(glm::quarter_pi<double>()) / slab_ior;
  const double distance = slab_depth / std::sqrt(1.0 - sine * sine);
  for (int c = 0; c < 3; ++c) {
    const double left = std::pow(tinted.attenuation_color[c], distance);
    EXPECT_NEAR(seen.white[c], left * slab_transmittance(), 0.015) << "channel " << c;
  }
}

// KHR_materials_dispersion: 20 / dispersion is the Abbe number.
TEST(GlassInReference, DispersionShiftsColorsApart) {
  MaterialLayers prism = volume(slab_depth);
  prism.dispersion = 5.0f;
  RendererRig rig = slab_before_edge(prism);
  const SeenEdge seen = seen_edge(rig, path_traced(), "dispersing_slab_reference");
  const double half_range = 0.5 * (slab_ior - 1.0) * prism.dispersion / 20.0;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen.begins[c], lateral_shift(slab_ior + (c - 1) * half_range), 0.007)
        << "channel " << c;
    EXPECT_NEAR(seen.white[c], slab_transmittance(), 0.025) << "channel " << c;
  }
}

class GlassInHybrid : public testing::TestWithParam<protocol::PrimaryVisibility> {};
INSTANTIATE_TEST_SUITE_P(Sources, GlassInHybrid,
                         testing::Values(protocol::PrimaryVisibility::rays,
                                         protocol::PrimaryVisibility::raster),
                         [](const auto& tested) {
                           return std::string(protocol::enum_name(tested.param));
                         });

TEST_P(GlassInHybrid, SlabShiftsAndDimsAsInReference) {
  MaterialLayers tinted = volume(slab_depth);
  tinted.attenuation_distance = 1.0f;
  tinted.attenuation_color = {0.9f, 0.6f, 0.4f};
  RendererRig rig = slab_before_edge(tinted);
  const SeenEdge expected = seen_edge(rig, path_traced(), "slab_expected");
  const SeenEdge seen = seen_edge(rig, hybrid_from(GetParam()), "slab_hybrid");
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen.begins[c], expected.begins[c], 0.01) << "channel " << c;
    EXPECT_NEAR(seen.white[c], expected.white[c], 0.03) << "channel " << c;
  }
}

TEST_P(GlassInHybrid, DispersionShiftsColorsApart) {
  MaterialLayers prism = volume(slab_depth);
  prism.dispersion = 5.0f;
  RendererRig rig = slab_before_edge(prism);
  const SeenEdge seen = seen_edge(rig, hybrid_from(GetParam()), "dispersing_slab_hybrid");
  EXPECT_NEAR(seen.begins.z - seen.begins.x,
              lateral_shift(slab_ior + 0.0625) - lateral_shift(slab_ior - 0.0625), 0.008);
}

/// Fraction of the pixels before the white part of the wall that show it in a single frame, through
/// glass that splits light and lets some colours pass. Through others a ray was reflected within.
double shown_in_one_frame(const glm::vec3& passing, protocol::PrimaryVisibility source) {
  MaterialLayers prism = volume(slab_depth);
  prism.dispersion = 5.0f;
  RendererRig rig = slab_before_edge(prism, passing);
  mean_color(rig, hybrid_from(source), "dispersing_slab_one_frame", 1);
  const render::FloatImage radiance = rig.capture("accumulated");
  std::uint32_t shown = 0, pixels = 0;
  for (std::uint32_t y = 0; y < slab_view; ++y) {
    for (std::uint32_t x = slab_view * 3 / 4; x < slab_view; ++x) {
      // What is reflected by chance makes up for it in the rays that pass: a third at the most.
      const glm::vec3 seen = rgb(radiance, x, y);
      const glm::bvec3 lit = glm::greaterThan(seen, glm::vec3(0.7f));
      const glm::bvec3 bright = glm::greaterThan(seen, glm::vec3(1.4f));
      shown += lit == glm::greaterThan(passing, glm::vec3(0.0f)) && !glm::any(bright);
      ++pixels;
    }
  }
  return static_cast<double>(shown) / pixels;
}

// A ray has one of three bands of wavelengths; a pixel shows all of them in every frame, also where
// nothing is left of some.
TEST_P(GlassInHybrid, DispersionKeepsColorsInEveryFrame) {
  EXPECT_GT(shown_in_one_frame({1, 1, 1}, GetParam()), 0.5);
  EXPECT_GT(shown_in_one_frame({1, 0, 0}, GetParam()), 0.5);
}

TEST_P(GlassInHybrid, WithoutRefractionWallShowsStraight) {
  RendererRig rig = slab_before_edge(volume(slab_depth));
  protocol::Settings settings = hybrid_from(GetParam());
  settings.transmission.refraction = false;
  const SeenEdge seen = seen_edge(rig, settings, "slab_straight");
  EXPECT_NEAR(seen.begins.y, 0.0, 0.006);
}

// Frosted panes blur what is behind them: next to the edge the wall is neither black nor white.
TEST_P(GlassInHybrid, RoughThinWallBlursWhatIsBehind) {
  SceneBuilder builder;
  const auto pane = builder.with_layers(surface(glm::vec3(1.0f), 0.5f), volume(0.0f));
  builder.place(builder.add_quad({{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}}, pane));
  builder.place(
      builder.add_quad({{{-9, -9, -1}, {0, -9, -1}, {0, 9, -1}, {-9, 9, -1}}}, unlit({0, 0, 0})));
  builder.place(
      builder.add_quad({{{0, -9, -1}, {9, -9, -1}, {9, 9, -1}, {0, 9, -1}}}, unlit({1, 1, 1})));
  scene::Camera camera = look({0, 0, 6}, {0, 0, 0});
  camera.orthographic_height = 1.0f;
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)), camera, 32, 32);
  const auto column = [&](const protocol::Settings& settings, std::uint32_t x) {
    mean_color(rig, settings, "frosted_pane", 128);
    const render::FloatImage radiance = rig.capture("accumulated");
    double sum = 0.0;
    for (std::uint32_t y = 0; y < 32; ++y) sum += rgb(radiance, x, y).y;
    return sum / 32.0;
  };
  for (const std::uint32_t x : {6u, 12u, 19u, 26u}) {
    const double expected = column(path_traced(), x);
    EXPECT_GT(expected, 0.05);
    EXPECT_LT(expected, 0.9);
    EXPECT_NEAR(column(hybrid_from(GetParam()), x), expected, 0.05) << "column " << x;
  }
}

// White glass absorbs nothing, whatever its roughness.
TEST(GlassInReference, WhiteGlassVanishesInFurnace) {
  for (const float thickness : {0.0f, 0.9f}) {
    SceneBuilder builder;
    for (int i = 0; i < 4; ++i) {
      MaterialLayers glass = volume(thickness);
      glass.transmission = i == 3 ? 0.5f : 1.0f;
      const auto material = surface(glm::vec3(1.0f), 0.2f * static_cast<float>(i));
      builder.place(builder.add_sphere(0.45f, builder.with_layers(material, glass)),
                    glm::translate(glm::mat4(1.0f), {static_cast<float>(i) - 1.5f, 0, 0}));
    }
    RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                    look({0, 0, 6}, {0, 0, 0}, 12.0f), 96, 32);  // half of it glass
    protocol::Settings settings = path_traced();
    settings.reference.bounces = 16;
    const glm::dvec3 mean = mean_color(rig, settings, "furnace_refraction", 128);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1.0, 0.01) << "thickness " << thickness;
  }
}

/// A glass ball before a checkered wall that shines by itself.
std::shared_ptr<const scene::Scene> ball_before_checks() {
  SceneBuilder builder;
  MaterialLayers glass = volume(1.0f);
  glass.attenuation_distance = 2.0f;
  glass.attenuation_color = {0.6f, 0.9f, 0.8f};
  builder.place(
      builder.add_sphere(0.8f, builder.with_layers(surface(glm::vec3(1.0f), 0.0f), glass)));
  for (int i = 0; i < 64; ++i) {
    const float x = static_cast<float>(i % 8) - 4.0f, y = static_cast<float>(i / 8) - 4.0f;
    const glm::vec3 color = (i + i / 8) % 2 ? glm::vec3(0.9f, 0.8f, 0.3f) : glm::vec3(0.1f);
    builder.place(builder.add_quad(
        {{{x, y, -2}, {x + 1, y, -2}, {x + 1, y + 1, -2}, {x, y + 1, -2}}}, unlit(color)));
  }
  return builder.build();
}

TEST_P(GlassInHybrid, BallLooksAsInReference) {
  RendererRig rig(ball_before_checks(), scene::constant_environment(glm::vec3(0.4f)),
                  look({0, 0, 4}, {0, 0, 0}, 30.0f), 96, 96);
  const auto shown = [&](const protocol::Settings& settings, const std::string& name) {
    rig.apply(settings);
    render::Frame frame = rig.accumulate(64);
    save_image(name, frame);
    return frame;
  };
  const render::Frame expected = shown(path_traced(), "glass_ball_reference");
  protocol::Settings settings = hybrid_from(GetParam());
  const double refracted = ssim(expected, shown(settings, "glass_ball_hybrid"));
  settings.transmission.refraction = false;
  const double straight = ssim(expected, shown(settings, "glass_ball_straight"));
  EXPECT_GT(refracted, 0.93);
  EXPECT_GT(refracted, straight + 0.1);
}

}  // namespace
}  // namespace heliograph::test
