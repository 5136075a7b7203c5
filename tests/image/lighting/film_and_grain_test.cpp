// Thin films (KHR_materials_iridescence) and grain (KHR_materials_anisotropy).
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using scene::MaterialLayers;

MaterialLayers filmed(float ior, float thickness, float share = 1.0f) {
  return {.iridescence = share, .iridescence_ior = ior, .iridescence_thickness_maximum = thickness};
}

MaterialLayers grained(float strength, float rotation = 0.0f) {
  return {.anisotropy = strength, .anisotropy_rotation = rotation};
}

glm::mat4 beside(int column, int row) {
  return glm::translate(glm::mat4(1.0f), glm::vec3(static_cast<float>(column) - 1.5f,
                                                   0.5f - static_cast<float>(row), 0.0f));
}

/// White spheres of several roughness, four in a row: dielectrics, then metals.
std::shared_ptr<const scene::Scene> white_spheres_with(const MaterialLayers (&layers)[4]) {
  SceneBuilder builder;
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 4; ++i) {
      const float roughness = 0.1f + 0.25f * static_cast<float>(i);
      const auto white = surface(glm::vec3(1.0f), roughness, static_cast<float>(row));
      builder.place(builder.add_sphere(0.45f, builder.with_layers(white, layers[i])),
                    beside(i, row));
    }
  }
  return builder.build();
}

/// In a white furnace.
render::FloatImage furnace(std::shared_ptr<const scene::Scene> scene, bool rays,
                           const std::string& name) {
  RendererRig rig(std::move(scene), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 36.0f), 128, 72);
  protocol::Settings settings = undenoised();
  settings.ambient.occlusion = settings.lighting.direct = false;
  settings.specular.enabled = rays;
  rig.apply(settings);
  save_image(name, rig.accumulate(rays ? 96 : 4));
  return rig.capture("accumulated");
}

struct Extremes {
  float least = 1e9f, most = 0.0f;
  double mean = 0.0;
};

Extremes extremes(const render::FloatImage& radiance) {
  Extremes found;
  for (std::size_t i = 0; i < radiance.rgba.size(); ++i) {
    if (i % 4 == 3) continue;  // the mean's variance
    found.least = std::min(found.least, radiance.rgba[i]);
    found.most = std::max(found.most, radiance.rgba[i]);
    found.mean += radiance.rgba[i];
  }
  found.mean /= static_cast<double>(radiance.rgba.size()) * 0.75;
  return found;
}

TEST(FilmFurnace, FilmsAddNoEnergyAndTakeSome) {
  const MaterialLayers films[4] = {filmed(1.3f, 400.0f), filmed(2.2f, 250.0f), filmed(1.8f, 800.0f),
                                   filmed(1.6f, 120.0f, 0.5f)};
  const Extremes found = extremes(furnace(white_spheres_with(films), false, "furnace_film"));
  EXPECT_LT(found.most, 1.02f);
  EXPECT_GT(found.least, 0.1f);
  EXPECT_LT(found.least, 0.98f) << "no film is there";
}

TEST(GrainFurnace, AlbedosAreThoseOfSurfacesWithoutGrain) {
  const MaterialLayers grains[4] = {grained(0.3f), grained(0.6f), grained(0.9f, 1.0f),
                                    grained(1.0f)};
  const Extremes found = extremes(furnace(white_spheres_with(grains), false, "furnace_grain"));
  EXPECT_LT(found.most, 1.02f);
  EXPECT_GT(found.least, 0.98f);
}

// What microfacets reflect more than once is given back as if the lobe were round: less than there
// is, the more so the stronger the grain.
TEST(GrainFurnace, RaysAddNoEnergy) {
  const MaterialLayers grains[4] = {grained(0.3f), grained(0.5f), grained(0.6f, 1.0f),
                                    grained(0.6f)};
  const Extremes found = extremes(furnace(white_spheres_with(grains), true, "furnace_grain_rays"));
  EXPECT_LT(found.mean, 1.005);
  EXPECT_GT(found.mean, 0.95);
}

/// What a mirror with a film, but for the film black where it does not reflect, shows head on of
/// white light.
glm::vec3 seen_head_on(const MaterialLayers& layers) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}},
                                 builder.with_layers(surface(glm::vec3(0.0f), 0.0f), layers)));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 3}, {0, 0, 0}, 10.0f), 33, 33);
  protocol::Settings settings = undenoised();
  settings.specular.enabled = settings.lighting.direct = settings.ambient.occlusion = false;
  rig.apply(settings);
  rig.accumulate(1);
  return rgb(rig.capture("hdr"), 16, 16);
}

// Reflectances by hand, of the base's index of 1.5.
TEST(Film, ReflectsWhatInterferenceLeaves) {
  const float plain = seen_head_on({}).y;
  EXPECT_NEAR(plain, 0.04f, 0.004f);
  EXPECT_NEAR(seen_head_on(filmed(1.8f, 0.0f)).y, plain, 0.003f) << "no film";
  // A thick film has no colour: both boundaries add up, ((n - 1) / (n + 1))^2 first.
  const glm::vec3 thick = seen_head_on(filmed(1.8f, 50000.0f));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(thick[c], 0.0886f, 0.006f) << "channel " << c;
  // The index sqrt(1.5), a quarter of 550 nm thick: both reflections cancel each other.
  EXPECT_LT(seen_head_on(filmed(1.2247f, 112.3f)).y, 0.008f);
  // Half of a wave thick it is not seen.
  EXPECT_NEAR(seen_head_on(filmed(1.2247f, 224.5f)).y, plain, 0.008f);
  // Denser than the base: a quarter of a wave reflects the most, 0.165 for an index of 2.
  EXPECT_GT(seen_head_on(filmed(2.0f, 68.75f)).y, 0.13f);
}

TEST(Film, ColoursDependOnThickness) {
  const glm::vec3 thin = seen_head_on(filmed(1.8f, 250.0f));
  const glm::vec3 thicker = seen_head_on(filmed(1.8f, 400.0f));
  const auto ratio = [](const glm::vec3& color) { return color.x / color.z; };
  EXPECT_GT(std::max(ratio(thin) / ratio(thicker), ratio(thicker) / ratio(thin)), 1.3f);
}

/// The sun's highlight on a wall whose tangent is x: beside the middle and above it.
std::pair<float, float> highlight(const MaterialLayers& layers) {
  SceneBuilder builder;
  builder.place(
      builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}},
                       builder.with_layers(surface(glm::vec3(0.9f), 0.3f, 1.0f), layers)));
  builder.add_sun({0, 0, -1}, glm::vec3(1.0f));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 3}, {0, 0, 0}, 36.0f), 65, 65);
  protocol::Settings settings = undenoised();
  settings.specular.enabled = false;
  rig.apply(settings);
  rig.accumulate(1);
  const render::FloatImage radiance = rig.capture("hdr");
  return {rgb(radiance, 60, 32).y, rgb(radiance, 32, 4).y};
}

TEST(Grain, HighlightIsLongAlongTheRougherDirection) {
  const auto [round_beside, round_above] = highlight({});
  EXPECT_NEAR(round_beside / round_above, 1.0f, 0.02f);
  const auto [beside, above] = highlight(grained(0.8f));
  EXPECT_GT(beside, 2.0f * above);
  const auto [turned_beside, turned_above] =
      highlight(grained(0.8f, std::numbers::pi_v<float> / 2));
  EXPECT_NEAR(turned_above / beside, 1.0f, 0.1f);
  EXPECT_NEAR(turned_beside / above, 1.0f, 0.1f);
}

/// Spheres and walls of every direction with films and grain, some under a coat.
std::shared_ptr<const scene::Scene> soap_and_steel() {
  SceneBuilder builder;
  MaterialLayers coated = grained(0.8f, 0.7f);
  coated.clearcoat = 0.8f;
  coated.clearcoat_roughness = 0.1f;
  coated.sheen_color = {0.2f, 0.3f, 0.4f};
  coated.sheen_roughness = 0.5f;
  MaterialLayers both = filmed(1.6f, 350.0f);
  both.anisotropy = 0.6f;
  const shared::Material materials[] = {
      builder.with_layers(surface({0.05f, 0.05f, 0.05f}, 0.2f), filmed(1.4f, 450.0f)),
      builder.with_layers(surface({0.8f, 0.8f, 0.7f}, 0.3f, 1.0f), filmed(2.0f, 300.0f)),
      builder.with_layers(surface({0.7f, 0.7f, 0.8f}, 0.25f, 1.0f), grained(0.9f)),
      builder.with_layers(surface({0.6f, 0.2f, 0.1f}, 0.3f, 0.6f), coated),
      builder.with_layers(surface({0.9f, 0.7f, 0.4f}, 0.35f, 1.0f), both)};
  for (int i = 0; i < 5; ++i) {
    builder.place(builder.add_sphere(0.6f, materials[i]),
                  glm::translate(glm::mat4(1.0f), {1.4f * static_cast<float>(i) - 2.8f, 0.6f, 0}));
  }
  const auto steel =
      builder.with_layers(surface({0.6f, 0.6f, 0.6f}, 0.3f, 1.0f), grained(0.7f, 0.4f));
  builder.place(builder.add_quad({{{-6, 0, 4}, {6, 0, 4}, {6, 0, -4}, {-6, 0, -4}}}, steel));
  builder.place(builder.add_quad({{{-6, 0, -2}, {6, 0, -2}, {6, 4, -2}, {-6, 4, -2}}}, steel));
  builder.place(builder.add_quad({{{-4, 0, 4}, {-4, 0, -4}, {-4, 4, -4}, {-4, 4, 4}}}, steel));
  builder.add_sun({0.5f, -1, -0.4f}, {3.0f, 2.8f, 2.4f}).add_point_light({2, 2, 1}, {4, 3, 2});
  return builder.build();
}

glm::vec3 film_sky(const glm::vec3& d) {
  return glm::vec3(0.5f, 0.6f, 0.8f) + glm::vec3(0.3f, 0.2f, 0.1f) * d.y + 0.2f * d.x;
}

class FilmAndGrain : public testing::TestWithParam<protocol::PrimaryVisibility> {};

// The hybrid stores the film's colours and the grain in the G-buffer.
TEST_P(FilmAndGrain, HybridConvergesToPathTracerAlongSamePaths) {
  RendererRig rig(soap_and_steel(), make_environment(128, film_sky), look({0, 2, 6}, {0, 0.7f, 0}),
                  96, 54);
  protocol::Settings hybrid = undenoised();
  hybrid.gbuffer.source = GetParam();
  protocol::Settings reference = undenoised();
  reference.reference.use = protocol::ReferenceUse::always;
  reference.reference.scope = protocol::ReferenceScope::same_paths;
  const glm::dvec3 got = mean_color(rig, hybrid, "film_and_grain_hybrid");
  const glm::dvec3 expected = mean_color(rig, reference, "film_and_grain_reference");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.015) << "channel " << c;
}

INSTANTIATE_TEST_SUITE_P(Sources, FilmAndGrain,
                         testing::Values(protocol::PrimaryVisibility::rays,
                                         protocol::PrimaryVisibility::raster));

// More bounces add light, and the lobes are those of the hybrid.
TEST(FilmAndGrainInReference, FullReferenceHasTheLightOfOneBounce) {
  RendererRig rig(soap_and_steel(), make_environment(128, film_sky), look({0, 2, 6}, {0, 0.7f, 0}),
                  96, 54);
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::same_paths;
  const double single = mean_color(rig, settings, "film_and_grain_same").y;
  settings.reference.scope = protocol::ReferenceScope::full;
  const double full = mean_color(rig, settings, "film_and_grain_full").y;
  EXPECT_GT(full / single, 0.9);
  EXPECT_LT(full / single, 1.35);
}

}  // namespace
}  // namespace heliograph::test
