#include "render/passes/compose/compose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "tests/gpu/support/uniform_gbuffer.hpp"
#include "tests/support/brdf_reference.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{16, 16};
constexpr std::size_t pixels = extent.width * extent.height;

struct Denoised {
  glm::vec3 visibility;
  glm::vec3 specular;
};

struct Inputs {
  SurfacePixel pixel;
  float shadow = 1.0f;
  float ambient = 1.0f;
  std::optional<glm::vec3> specular;
  std::optional<Denoised> denoised;
  glm::vec3 background{0.0f};
  protocol::Settings settings = without_indirect();
};

struct ComposedImages {
  glm::vec3 hdr, hdr_noisy;
};

/// Composed radiance of the center pixel, seen from (0, 0, 2) along -z.
ComposedImages compose_both(SceneBuilder& scene, const Inputs& in) {
  FrameRig rig(scene.build(), look({0, 0, 2}, {0, 0, 0}),
               {.extent = extent, .settings = in.settings});
  const auto gbuffer = make_uniform_gbuffer(rig, in.pixel);
  const auto flat = [&](const char* name, float value) {
    return rig.input(name, VK_FORMAT_R32_SFLOAT, std::vector(pixels, value));
  };
  const auto colored = [&](const char* name, const glm::vec3& value) {
    return rig.input(name, VK_FORMAT_R32G32B32A32_SFLOAT, std::vector(pixels, glm::vec4(value, 1)));
  };
  const auto background = colored("background", in.background);
  render::NoisySignals raw{flat("shadow", in.shadow), flat("ambient", in.ambient), {}};
  if (in.specular) raw.specular = colored("specular", *in.specular);
  std::optional<render::DenoisedSignals> denoised;
  if (in.denoised) {
    denoised = {colored("visibility", in.denoised->visibility),
                colored("denoised specular", in.denoised->specular)};
  }
  const auto composed =
      render::compose(rig.plan(), rig.inputs(), gbuffer, raw, denoised, background);
  rig.run();
  return {glm::vec3(texel(rig.read(composed.hdr), 8, 8)),
          glm::vec3(texel(rig.read(composed.noisy), 8, 8))};
}

glm::vec3 compose(SceneBuilder& scene, const Inputs& in) {
  return compose_both(scene, in).hdr;
}

protocol::Settings only_direct() {
  protocol::Settings settings = without_indirect();
  settings.lighting.environment_diffuse = settings.lighting.environment_specular = false;
  return settings;
}

TEST(Compose, SunOnDielectricPlaneIsAnalytic) {
  for (const float degrees : {0.0f, 30.0f, 60.0f, 80.0f}) {
    const float angle = glm::radians(degrees);
    SceneBuilder scene;
    scene.add_sun({std::sin(angle), 0, -std::cos(angle)}, {4, 2, 1});
    Inputs in;
    in.pixel.color = glm::vec3(0.25f);  // its root, 0.5, is not representable in 8 bits
    in.settings = only_direct();
    const double albedo = std::pow(128.0 / 255.0, 2.0);
    const double cosine = std::cos(angle);
    const double expected =
        4.0 * shade_light_reference(albedo, 0.0, 1.0, {0, 0, 1}, {std::sin(angle), 0, cosine});
    const glm::vec3 got = compose(scene, in);
    // The pixel next to the center sees the plane at almost normal incidence.
    EXPECT_NEAR(got.x, expected, 0.01 * expected) << degrees;
    EXPECT_NEAR(got.y, 0.5 * got.x, 1e-5);
    EXPECT_NEAR(got.x, 4.0 * cosine * albedo / std::numbers::pi, 0.12 * got.x) << "about Lambert";
  }
}

TEST(Compose, LightFromBehindContributesNothing) {
  SceneBuilder scene;
  scene.add_sun({0.2f, 0, 1}, glm::vec3(4.0f));
  Inputs in;
  in.settings = only_direct();
  EXPECT_EQ(compose(scene, in), glm::vec3(0.0f));
}

TEST(Compose, ShadowScalesDirectLightOnly) {
  SceneBuilder scene;
  scene.add_sun({0, 0, -1}, glm::vec3(4.0f));
  Inputs in;
  in.settings = only_direct();
  const float lit = compose(scene, in).x;
  in.shadow = 0.25f;
  EXPECT_NEAR(compose(scene, in).x, 0.25f * lit, 1e-5f);
  in.settings.shadows.enabled = false;
  EXPECT_NEAR(compose(scene, in).x, lit, 1e-5f);
  in.settings = without_indirect();
  in.settings.lighting.direct = false;
  EXPECT_NEAR(compose(scene, in).x, 1.0f, 0.02f) << "a white plane in a white furnace";
}

TEST(Compose, AmbientVisibilityAndOcclusionMapScaleEnvironment) {
  SceneBuilder scene;
  Inputs in;
  const float open = compose(scene, in).x;
  in.ambient = 0.5f;
  EXPECT_NEAR(compose(scene, in).x, 0.5f * open, 1e-4f);
  in.pixel.occlusion = 51.0f / 255.0f;
  EXPECT_NEAR(compose(scene, in).x, 0.1f * open, 1e-4f);
  in.settings.ambient.occlusion = false;
  EXPECT_NEAR(compose(scene, in).x, 0.2f * open, 1e-4f);
}

TEST(Compose, TracedReflectionsReplacePrefilteredEnvironment) {
  SceneBuilder scene;
  Inputs in;
  in.pixel.metallic = 1.0f;
  in.pixel.color = glm::vec3(1.0f);
  in.specular = glm::vec3(3, 2, 1);
  const glm::vec3 metal = compose(scene, in);
  EXPECT_NEAR(metal.x, 3.0f, 0.01f) << "a white metal reflects the signal unchanged";
  EXPECT_NEAR(metal.z, 1.0f, 0.01f);
  in.ambient = 0.25f;
  EXPECT_EQ(compose(scene, in), metal) << "ambient visibility must not scale traced reflections";
  in.settings.specular.max_roughness = 0.5f;
  EXPECT_NEAR(compose(scene, in).x, 0.25f, 0.01f) << "rougher than specular.max_roughness";
  in.pixel.roughness = 0.5f;
  EXPECT_NEAR(compose(scene, in).x, 3.0f, 0.01f) << "at specular.max_roughness";
  in.specular.reset();
  EXPECT_NEAR(compose(scene, in).x, 0.25f, 0.01f) << "the prefiltered environment";
}

TEST(Compose, DenoisedSignalsMakeHdrAndNoisyOnesMakeSample) {
  SceneBuilder scene;
  scene.add_sun({0, 0, -1}, glm::vec3(4.0f));
  Inputs in;
  in.pixel.roughness = 0.3f;
  in.shadow = 0.0f;
  in.ambient = 1.0f;
  in.specular = glm::vec3(7.0f);
  const glm::vec3 raw = compose(scene, in);
  Inputs smooth = in;
  smooth.shadow = 0.5f;
  smooth.ambient = 0.75f;
  smooth.specular = glm::vec3(2.0f);
  const glm::vec3 filtered = compose(scene, smooth);
  in.denoised = Denoised{{0.5f, 0.75f, 0.0f}, glm::vec3(2.0f)};
  const ComposedImages both = compose_both(scene, in);
  EXPECT_EQ(both.hdr, filtered);
  EXPECT_EQ(both.hdr_noisy, raw);
  EXPECT_NE(raw, filtered);
}

TEST(Compose, UnlitShowsBaseColorPlusEmission) {
  SceneBuilder scene;
  scene.add_sun({0, 0, -1}, glm::vec3(4.0f));
  Inputs in;
  in.pixel.unlit = true;
  in.pixel.color = glm::vec3(std::pow(51.0f / 255.0f, 2.0f));
  EXPECT_NEAR(compose(scene, in).x, in.pixel.color.x, 1e-5f);
  in.pixel.emissive = {0.5f, 1.0f, 1.5f};
  const glm::vec3 glowing = compose(scene, in);
  EXPECT_NEAR(glowing.x, in.pixel.color.x + 0.5f, 1e-5f);
  EXPECT_NEAR(glowing.z, in.pixel.color.x + 1.5f, 1e-5f);
  in.settings.lighting.emissive = false;
  EXPECT_NEAR(compose(scene, in).z, in.pixel.color.x, 1e-5f);
}

TEST(Compose, BackgroundShowsWhereNoSurfaceIs) {
  SceneBuilder scene;
  Inputs in;
  in.pixel.view_z = 0.0f;
  in.background = {3, 2, 1};
  EXPECT_EQ(compose(scene, in), in.background);
}

TEST(Compose, NaNBecomesBlack) {
  SceneBuilder scene;
  scene.add_sun({0, 0, -1}, glm::vec3(4.0f));
  Inputs in;
  in.shadow = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compose(scene, in), glm::vec3(0.0f));
}

}  // namespace
}  // namespace heliograph::test
