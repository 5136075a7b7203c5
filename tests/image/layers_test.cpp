// What extensions add to glTF's own material: index of refraction, specular strength and colour, clear
// coats, light that passes through.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/still.hpp"

namespace heliograph::test {
namespace {

using scene::MaterialLayers;

glm::mat4 at(float x, float y, float z) {
  return glm::translate(glm::mat4(1.0f), glm::vec3(x, y, z));
}

protocol::Settings undenoised() {
  protocol::Settings settings;
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.antialiasing.temporal = false;
  settings.accumulation.max_samples = 4096;
  return settings;
}

MaterialLayers coat(float amount, float roughness) {
  MaterialLayers layers;
  layers.clearcoat = amount;
  layers.clearcoat_roughness = roughness;
  return layers;
}

MaterialLayers tinted(const glm::vec3& color, float specular = 1.0f) {
  MaterialLayers layers;
  layers.specular = specular;
  layers.specular_color = color;
  return layers;
}

MaterialLayers glass(float transmission) {
  MaterialLayers layers;
  layers.transmission = transmission;
  return layers;
}

/// Spheres of white surfaces of many layers, roughnesses and metalnesses.
SceneBuilder white_things() {
  SceneBuilder builder;
  shared::Material dense = surface(glm::vec3(1.0f), 0.3f);
  dense.ior = 2.4f;
  const auto white = [](float roughness, float metallic) {
    return surface(glm::vec3(1.0f), roughness, metallic);
  };
  const std::vector<shared::Material> materials{
      builder.with_layers(white(0.5f, 0.0f), coat(1.0f, 0.0f)),
      builder.with_layers(white(0.5f, 1.0f), coat(1.0f, 0.3f)),
      builder.with_layers(white(0.0f, 0.5f), coat(0.5f, 0.8f)),
      builder.with_layers(dense, {}),
      builder.with_layers(white(0.2f, 0.0f), tinted(glm::vec3(1.0f), 0.5f)),
      builder.with_layers(white(0.6f, 0.0f), tinted(glm::vec3(4.0f))),
      builder.with_layers(white(0.0f, 0.0f), tinted(glm::vec3(0.0f))),
      builder.with_layers(white(0.1f, 0.3f), coat(1.0f, 1.0f))};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    builder.place(builder.add_sphere(0.45f, materials[i]),
                  at(static_cast<float>(i % 4) - 1.5f, i < 4 ? 0.5f : -0.5f, 0.0f));
  }
  return builder;
}

TEST(LayersInAFurnace, KeepTheEnergy) {
  Still still(white_things().build(), scene::constant_environment(glm::vec3(1.0f)),
              look({0, 0, 6}, {0, 0, 0}, 36.0f), 160, 90);
  protocol::Settings settings;
  settings.ambient.occlusion = false;
  settings.lighting.direct = false;
  settings.specular.enabled = false;
  still.apply(settings);
  save_picture("furnace_layers", still.accumulate(4));
  const render::FloatImage radiance = still.capture("accumulated");
  for (std::size_t i = 0; i < radiance.rgba.size(); ++i) {
    ASSERT_NEAR(radiance.rgba[i], 1.0f, 0.02f) << "pixel " << i / 4 % 160 << ", " << i / 640;
  }
}

TEST(LayersInAFurnace, KeepItAlongRaysToo) {
  Still still(white_things().build(), scene::constant_environment(glm::vec3(1.0f)),
              look({0, 0, 6}, {0, 0, 0}, 36.0f), 96, 54);
  protocol::Settings settings = undenoised();
  settings.ambient.occlusion = false;
  settings.lighting.direct = false;
  still.apply(settings);
  save_picture("furnace_layers_rays", still.accumulate(96));
  const render::FloatImage radiance = still.capture("accumulated");
  double sum = 0.0;
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) sum += radiance.rgba[i];
  EXPECT_NEAR(sum / (96.0 * 54.0), 1.0, 0.01);
}

// Light that passes is light that is not mirrored: nothing is brighter than the white around it.
TEST(LayersInAFurnace, GlassIsNeverBrighterThanWhatIsAround) {
  SceneBuilder builder;
  for (int i = 0; i < 4; ++i) {
    const float share = static_cast<float>(i + 1) / 4.0f;
    const auto material = surface(glm::vec3(1.0f), 0.1f * static_cast<float>(i));
    builder.place(builder.add_sphere(0.45f, builder.with_layers(material, glass(share))),
                  at(static_cast<float>(i) - 1.5f, 0, 0));
  }
  Still still(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
              look({0, 0, 6}, {0, 0, 0}, 36.0f), 160, 60);
  protocol::Settings settings = undenoised();
  settings.ambient.occlusion = false;
  settings.lighting.direct = false;
  settings.specular.enabled = false;
  still.apply(settings);
  save_picture("furnace_glass", still.accumulate(64));
  const render::FloatImage radiance = still.capture("accumulated");
  for (std::size_t i = 0; i < radiance.rgba.size(); ++i) {
    ASSERT_LE(radiance.rgba[i], 1.02f);
    ASSERT_GE(radiance.rgba[i], 0.3f);
  }
}

/// Coated, tinted, dense and see-through things on a coated floor under sun and lamp.
std::shared_ptr<const scene::Scene> workshop() {
  SceneBuilder builder;
  shared::Material dense = surface({0.1f, 0.1f, 0.3f}, 0.1f);
  dense.ior = 2.4f;
  const auto floor = builder.add_quad(
      {{{-6, 0, 4}, {6, 0, 4}, {6, 0, -6}, {-6, 0, -6}}},
      builder.with_layers(surface({0.6f, 0.5f, 0.4f}, 0.6f), coat(1.0f, 0.1f)));
  builder.place(floor);
  const std::vector<shared::Material> materials{
      builder.with_layers(surface({0.7f, 0.1f, 0.1f}, 0.5f, 0.6f), coat(1.0f, 0.0f)),
      builder.with_layers(surface({0.2f, 0.2f, 0.2f}, 0.3f), tinted({1.0f, 0.3f, 0.1f})),
      builder.with_layers(dense, {}),
      builder.with_layers(surface({0.8f, 0.9f, 0.8f}, 0.05f), glass(0.9f))};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    builder.place(builder.add_sphere(0.6f, materials[i]),
                  at(1.4f * static_cast<float>(i) - 2.1f, 0.6f, i % 2 ? 0.4f : 0.0f));
  }
  builder.add_sun({0.5f, -1, -0.4f}, {3.0f, 2.8f, 2.4f}).add_lamp({2, 2, 1}, {4, 3, 2});
  return builder.build();
}

glm::vec3 sky(const glm::vec3& d) {
  return glm::vec3(0.5f, 0.6f, 0.8f) + glm::vec3(0.3f, 0.2f, 0.1f) * d.y + 0.2f * d.x;
}

glm::dvec3 mean_color(Still& still, const protocol::Settings& settings, const std::string& name) {
  still.apply(settings);
  save_picture(name, still.accumulate(96));
  const render::FloatImage radiance = still.capture("accumulated");
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) {
    for (int c = 0; c < 3; ++c) sum[c] += radiance.rgba[i + static_cast<std::size_t>(c)];
  }
  EXPECT_TRUE(std::isfinite(sum.x + sum.y + sum.z));
  return sum / (static_cast<double>(radiance.rgba.size()) / 4.0);
}

class Layers : public testing::TestWithParam<protocol::PrimaryVisibility> {};

// However the first surface is found, and whatever mirrored rays cost.
TEST_P(Layers, HybridConvergesToTheSamePaths) {
  Still still(workshop(), make_environment(128, sky), look({0, 2, 6}, {0, 0.7f, 0}), 96, 54);
  protocol::Settings hybrid = undenoised();
  hybrid.gbuffer.source = GetParam();
  protocol::Settings truth = undenoised();
  truth.reference.use = protocol::ReferenceUse::always;
  truth.reference.scope = protocol::ReferenceScope::same_paths;
  const glm::dvec3 got = mean_color(still, hybrid, "layers_hybrid");
  const glm::dvec3 expected = mean_color(still, truth, "layers_reference");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.012) << "channel " << c;
}

INSTANTIATE_TEST_SUITE_P(Sources, Layers,
                         testing::Values(protocol::PrimaryVisibility::rays,
                                         protocol::PrimaryVisibility::raster));

TEST(LayersOfTheReference, GlobalIlluminationIsBrighterByLittle) {
  Still still(workshop(), make_environment(128, sky), look({0, 2, 6}, {0, 0.7f, 0}), 96, 54);
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::same_paths;
  const double single = mean_color(still, settings, "layers_same").y;
  settings.reference.scope = protocol::ReferenceScope::full;
  const double full = mean_color(still, settings, "layers_full").y;
  EXPECT_GT(full / single, 0.9);
  EXPECT_LT(full / single, 1.35);
}

// A coat's highlight is as sharp as the coat, whatever lies under it.
TEST(Coat, MirrorsTheSunOnARoughSurface) {
  const auto highlight = [](const MaterialLayers& layers) {
    SceneBuilder builder;
    builder.place(builder.add_sphere(
        1.0f, builder.with_layers(surface({0.3f, 0.0f, 0.0f}, 0.9f), layers)));
    builder.add_sun({0, 0, -1}, glm::vec3(1.0f));
    Still still(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                look({0, 0, 4}, {0, 0, 0}, 36.0f), 65, 65);
    protocol::Settings settings = undenoised();
    still.apply(settings);
    still.accumulate(1);
    return rgb(still.capture("hdr"), 32, 32).y;
  };
  EXPECT_GT(highlight(coat(1.0f, 0.2f)), 20.0f * highlight({}));
  EXPECT_NEAR(highlight(coat(0.5f, 0.2f)) / highlight(coat(1.0f, 0.2f)), 0.5f, 0.02f);
}

}  // namespace
}  // namespace heliograph::test
