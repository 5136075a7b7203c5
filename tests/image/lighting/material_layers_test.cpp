// Material extensions of glTF: ior, specular, clearcoat, sheen, transmission and volume; factors
// and textures.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/import.hpp"
#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using scene::MaterialLayers;

glm::mat4 at(float x, float y, float z) {
  return glm::translate(glm::mat4(1.0f), glm::vec3(x, y, z));
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

MaterialLayers sheen(const glm::vec3& color, float roughness) {
  MaterialLayers layers;
  layers.sheen_color = color;
  layers.sheen_roughness = roughness;
  return layers;
}

/// White spheres with various layers, roughness and metalness.
SceneBuilder white_spheres() {
  SceneBuilder builder;
  shared::Material dense = surface(glm::vec3(1.0f), 0.3f);
  dense.ior = 2.4f;
  MaterialLayers coated_sheen = sheen(glm::vec3(1.0f), 0.5f);
  coated_sheen.clearcoat = 1.0f;
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
      builder.with_layers(white(0.1f, 0.3f), coat(1.0f, 1.0f)),
      builder.with_layers(white(0.5f, 0.0f), sheen(glm::vec3(1.0f), 0.3f)),
      builder.with_layers(white(0.3f, 1.0f), sheen(glm::vec3(1.0f), 1.0f)),
      builder.with_layers(white(1.0f, 0.0f), sheen(glm::vec3(0.7f), 0.0f)),
      builder.with_layers(white(0.6f, 0.0f), coated_sheen)};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    builder.place(builder.add_sphere(0.45f, materials[i]),
                  at(static_cast<float>(i % 4) - 1.5f, 1.0f - static_cast<float>(i / 4), 0.0f));
  }
  return builder;
}

void expect_white(const render::FloatImage& radiance) {
  for (std::size_t i = 0; i < radiance.rgba.size(); ++i) {
    if (i % 4 == 3) continue;  // the mean's variance
    const std::size_t pixel = i / 4;
    ASSERT_NEAR(radiance.rgba[i], 1.0f, 0.02f)
        << "pixel " << pixel % radiance.width << ", " << pixel / radiance.width;
  }
}

TEST(LayerFurnace, LayersConserveEnergy) {
  RendererRig rig(white_spheres().build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 36.0f), 160, 90);
  protocol::Settings settings;
  settings.indirect.enabled = settings.ambient.occlusion = false;
  settings.lighting.direct = false;
  settings.specular.enabled = false;
  rig.apply(settings);
  save_image("furnace_layers", rig.accumulate(4));
  const render::FloatImage radiance = rig.capture("accumulated");
  expect_white(radiance);
}

TEST(LayerFurnace, LayersConserveEnergyAlongRays) {
  RendererRig rig(white_spheres().build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 36.0f), 96, 54);
  protocol::Settings settings = undenoised();
  settings.ambient.occlusion = false;
  settings.lighting.direct = false;
  rig.apply(settings);
  save_image("furnace_layers_rays", rig.accumulate(96));
  const render::FloatImage radiance = rig.capture("accumulated");
  double sum = 0.0;
  for (std::size_t i = 0; i < radiance.rgba.size(); i += 4) sum += radiance.rgba[i];
  EXPECT_NEAR(sum / (96.0 * 54.0), 1.0, 0.01);
}

// White glass absorbs nothing: transmission, reflection and diffuse scattering sum to 1.
TEST(LayerFurnace, WhiteGlassVanishes) {
  SceneBuilder builder;
  for (int i = 0; i < 4; ++i) {
    const float transmission = static_cast<float>(i + 1) / 4.0f;
    const auto material = surface(glm::vec3(1.0f), 0.1f * static_cast<float>(i));
    builder.place(builder.add_sphere(0.45f, builder.with_layers(material, glass(transmission))),
                  at(static_cast<float>(i) - 1.5f, 0, 0));
  }
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 36.0f), 160, 60);
  protocol::Settings settings = undenoised();
  settings.ambient.occlusion = false;
  settings.lighting.direct = false;
  settings.specular.enabled = false;
  settings.transmission.refraction = false;  // without noise
  rig.apply(settings);
  save_image("furnace_glass", rig.accumulate(4));
  const render::FloatImage radiance = rig.capture("accumulated");
  expect_white(radiance);
}

/// Spheres with clearcoat, specular color, high ior, transmission and sheen on a coated floor,
/// under sun and point light.
std::shared_ptr<const scene::Scene> workshop() {
  SceneBuilder builder;
  shared::Material dense = surface({0.1f, 0.1f, 0.3f}, 0.1f);
  dense.ior = 2.4f;
  const auto floor =
      builder.add_quad({{{-6, 0, 4}, {6, 0, 4}, {6, 0, -6}, {-6, 0, -6}}},
                       builder.with_layers(surface({0.6f, 0.5f, 0.4f}, 0.6f), coat(1.0f, 0.1f)));
  builder.place(floor);
  const std::vector<shared::Material> materials{
      builder.with_layers(surface({0.7f, 0.1f, 0.1f}, 0.5f, 0.6f), coat(1.0f, 0.0f)),
      builder.with_layers(surface({0.2f, 0.2f, 0.2f}, 0.3f), tinted({1.0f, 0.3f, 0.1f})),
      builder.with_layers(dense, {}),
      builder.with_layers(surface({0.8f, 0.9f, 0.8f}, 0.05f), glass(0.9f)),
      builder.with_layers(surface({0.3f, 0.05f, 0.1f}, 0.8f), sheen({0.9f, 0.6f, 0.6f}, 0.4f))};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    builder.place(builder.add_sphere(0.6f, materials[i]),
                  at(1.4f * static_cast<float>(i) - 2.8f, 0.6f, i % 2 ? 0.4f : 0.0f));
  }
  builder.add_sun({0.5f, -1, -0.4f}, {3.0f, 2.8f, 2.4f}).add_point_light({2, 2, 1}, {4, 3, 2});
  return builder.build();
}

glm::vec3 layers_sky(const glm::vec3& d) {
  return glm::vec3(0.5f, 0.6f, 0.8f) + glm::vec3(0.3f, 0.2f, 0.1f) * d.y + 0.2f * d.x;
}

class Layers : public testing::TestWithParam<protocol::PrimaryVisibility> {};

// For primary visibility by rasterization and by rays.
TEST_P(Layers, HybridConvergesToPathTracerAlongSamePaths) {
  RendererRig rig(workshop(), make_environment(128, layers_sky), look({0, 2, 6}, {0, 0.7f, 0}), 96,
                  54);
  protocol::Settings hybrid = undenoised();
  hybrid.gbuffer.source = GetParam();
  protocol::Settings reference = undenoised();
  reference.reference.use = protocol::ReferenceUse::always;
  reference.reference.scope = protocol::ReferenceScope::same_paths;
  const glm::dvec3 got = mean_color(rig, hybrid, "layers_hybrid");
  const glm::dvec3 expected = mean_color(rig, reference, "layers_reference");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.012) << "channel " << c;
}

INSTANTIATE_TEST_SUITE_P(Sources, Layers,
                         testing::Values(protocol::PrimaryVisibility::rays,
                                         protocol::PrimaryVisibility::raster));

TEST(LayersInReference, GlobalIlluminationIsSlightlyBrighter) {
  RendererRig rig(workshop(), make_environment(128, layers_sky), look({0, 2, 6}, {0, 0.7f, 0}), 96,
                  54);
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::same_paths;
  const double single = mean_color(rig, settings, "layers_same").y;
  settings.reference.scope = protocol::ReferenceScope::full;
  const double full = mean_color(rig, settings, "layers_full").y;
  EXPECT_GT(full / single, 0.9);
  EXPECT_LT(full / single, 1.35);
}

/// A wall with a texture in every layer slot; its four quarters differ in each texture.
std::shared_ptr<const scene::Scene> textured_wall() {
  SceneBuilder builder;
  using Texels = std::vector<std::uint8_t>;
  const Texels strength{255, 255, 255, 255, 0, 0, 0, 0, 128, 128, 128, 128, 255, 255, 255, 255};
  const Texels colors{255, 60, 60, 255, 60, 255, 60, 255, 60, 60, 255, 255, 255, 255, 255, 255};
  const Texels bumps{128, 128, 255, 255, 200, 128, 220, 255, 128, 200, 220, 255, 60, 90, 220, 255};
  const auto slot = [&](bool srgb, const Texels& texels) {
    shared::TextureSlot made = scene::no_texture_slot();
    made.texture = builder.add_texture(2, 2, srgb, texels);
    return made;
  };
  MaterialLayers layers = tinted(glm::vec3(3.0f));
  layers.specular_texture = slot(false, strength);
  layers.specular_color_texture = slot(true, colors);
  layers.clearcoat = 1.0f;
  layers.clearcoat_roughness = 0.6f;
  layers.clearcoat_texture =
      slot(false, {255, 0, 0, 255, 128, 0, 0, 255, 0, 0, 0, 255, 255, 0, 0, 255});
  layers.clearcoat_roughness_texture = slot(false, strength);
  layers.clearcoat_normal_texture = slot(false, bumps);
  layers.sheen_color = glm::vec3(0.8f);
  layers.sheen_roughness = 0.6f;
  layers.sheen_color_texture = slot(true, colors);
  layers.sheen_roughness_texture = slot(false, strength);
  layers.transmission = 0.8f;
  layers.transmission_texture =
      slot(false, {0, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 255, 128, 0, 0, 255});
  layers.thickness = 1.0f;
  layers.attenuation_distance = 1.0f;
  layers.attenuation_color = {0.9f, 0.5f, 0.3f};
  layers.thickness_texture = slot(false, strength);
  const auto material = builder.with_layers(surface({0.5f, 0.4f, 0.3f}, 0.4f, 0.2f), layers);
  builder.place(builder.add_quad({{{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}}}, material));
  builder.place(builder.add_quad({{{-3, -2, -1}, {3, -2, -1}, {3, 2, -1}, {-3, 2, -1}}},
                                 surface({0.2f, 0.3f, 0.7f}, 0.7f)));
  builder.add_sun({0.3f, -0.5f, -1}, {2.0f, 1.8f, 1.6f})
      .add_point_light({0.5f, 0.3f, 1.5f}, {2, 2, 3});
  return builder.build();
}

/// Mean of a quarter of the wall, away from its edges.
glm::dvec3 quarter_mean(const render::FloatImage& radiance, std::uint32_t column,
                        std::uint32_t row) {
  glm::dvec3 sum(0.0);
  const std::uint32_t width = radiance.width / 2, height = radiance.height / 2;
  int count = 0;
  for (std::uint32_t y = row * height + height / 4; y < row * height + 3 * height / 4; ++y) {
    for (std::uint32_t x = column * width + width / 4; x < column * width + 3 * width / 4; ++x) {
      sum += glm::dvec3(rgb(radiance, x, y));
      ++count;
    }
  }
  return sum / static_cast<double>(count);
}

class LayerTextures : public testing::TestWithParam<protocol::PrimaryVisibility> {};

// The hybrid stores textured layer values in the G-buffer; the path tracer samples the textures.
TEST_P(LayerTextures, HybridMatchesReference) {
  scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  camera.orthographic_height = 2.0f;
  RendererRig rig(textured_wall(), make_environment(128, layers_sky), camera, 96, 48);
  protocol::Settings hybrid = undenoised();
  hybrid.gbuffer.source = GetParam();
  hybrid.transmission.refraction = false;
  protocol::Settings reference = undenoised();
  reference.reference.use = protocol::ReferenceUse::always;
  reference.reference.scope = protocol::ReferenceScope::same_paths;
  mean_color(rig, hybrid, "layer_textures_hybrid");
  const render::FloatImage got = rig.capture("accumulated");
  mean_color(rig, reference, "layer_textures_reference");
  const render::FloatImage expected = rig.capture("accumulated");
  for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
    const glm::dvec3 a = quarter_mean(got, quarter % 2, quarter / 2);
    const glm::dvec3 b = quarter_mean(expected, quarter % 2, quarter / 2);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(a[c] / b[c], 1.0, 0.025) << "quarter " << quarter << ", channel " << c;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sources, LayerTextures,
                         testing::Values(protocol::PrimaryVisibility::rays,
                                         protocol::PrimaryVisibility::raster));

// Khronos sample: rows of spheres with varying specular factor and color; textured rows must equal
// the rows with factors.
TEST(SpecularChart, TexturesMatchFactors) {
  const auto file = asset("gltf/SpecularTest.glb");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(*file));
  for (const std::string& warning : scene->warnings) {
    EXPECT_EQ(warning.find("left out"), std::string::npos) << warning;
  }
  std::size_t textured = 0;
  for (const shared::MaterialLayer& layer : scene->layers) {
    textured += layer.specular_texture.texture != shared::no_texture ||
                layer.specular_color_texture.texture != shared::no_texture;
  }
  EXPECT_GE(textured, 2u);
  RendererRig rig(scene, make_environment(128, layers_sky),
                  scene::fit_camera(scene->bounds, 40.0f, 4.0f / 3.0f), 160, 120);
  protocol::Settings reference = undenoised();
  reference.reference.use = protocol::ReferenceUse::always;
  reference.reference.scope = protocol::ReferenceScope::same_paths;
  const glm::dvec3 got = mean_color(rig, undenoised(), "specular_chart", 8);
  const glm::dvec3 expected = mean_color(rig, reference, "specular_chart_reference", 8);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.01) << "channel " << c;
}

// The clearcoat does not use the base normal map (KHR_materials_clearcoat).
TEST(Coat, IgnoresBaseNormalMap) {
  const auto tilted = [](bool coat_too) {
    SceneBuilder builder;
    const auto bump = builder.add_texture(1, 1, false, {200, 128, 220, 255});
    shared::Material rough = surface(glm::vec3(0.0f), 1.0f);
    rough.normal_texture.texture = bump;
    MaterialLayers layers = coat(1.0f, 0.2f);
    if (coat_too) layers.clearcoat_normal_texture.texture = bump;
    builder.place(builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}},
                                   builder.with_layers(rough, layers)));
    builder.add_sun({0, 0, -1}, glm::vec3(1.0f));
    RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                    look({0, 0, 3}, {0, 0, 0}, 20.0f), 33, 33);
    rig.apply(undenoised());
    rig.accumulate(1);
    return rgb(rig.capture("hdr"), 16, 16).y;
  };
  EXPECT_GT(tilted(false), 20.0f * tilted(true));
}

// Sheen scatters light at grazing angles.
TEST(Sheen, BrightensRim) {
  const auto rim = [](const MaterialLayers& layers) {
    SceneBuilder builder;
    builder.place(
        builder.add_sphere(1.0f, builder.with_layers(surface(glm::vec3(0.02f), 1.0f), layers)));
    builder.add_sun({0, 0.3f, -1}, glm::vec3(1.0f));
    RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                    look({0, 0, 4}, {0, 0, 0}, 36.0f), 65, 65);
    rig.apply(undenoised());
    save_image("sheen_rim", rig.accumulate(1));
    const render::FloatImage radiance = rig.capture("hdr");
    return std::pair(rgb(radiance, 32, 32).y, rgb(radiance, 32, 55).y);
  };
  const auto [plain_middle, plain_rim] = rim({});
  const auto [middle, edge] = rim(sheen(glm::vec3(0.8f), 0.5f));
  EXPECT_GT(edge, 2.0f * plain_rim);
  EXPECT_GT(edge / middle, 1.5f * plain_rim / plain_middle);
}

// The roughness of a clearcoat highlight is that of the coat.
TEST(Coat, HighlightOnRoughBaseHasCoatRoughness) {
  const auto highlight = [](const MaterialLayers& layers) {
    SceneBuilder builder;
    builder.place(
        builder.add_sphere(1.0f, builder.with_layers(surface({0.3f, 0.0f, 0.0f}, 0.9f), layers)));
    builder.add_sun({0, 0, -1}, glm::vec3(1.0f));
    RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                    look({0, 0, 4}, {0, 0, 0}, 36.0f), 65, 65);
    protocol::Settings settings = undenoised();
    rig.apply(settings);
    rig.accumulate(1);
    return rgb(rig.capture("hdr"), 32, 32).y;
  };
  EXPECT_GT(highlight(coat(1.0f, 0.2f)), 20.0f * highlight({}));
  EXPECT_NEAR(highlight(coat(0.5f, 0.2f)) / highlight(coat(1.0f, 0.2f)), 0.5f, 0.02f);
}

}  // namespace
}  // namespace heliograph::test
