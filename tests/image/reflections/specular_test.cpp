#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

/// Noisy reflections: denoising, antialiasing and occlusion are off.
protocol::Settings undenoised_reflections() {
  protocol::Settings settings;
  settings.indirect.enabled = false;
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.antialiasing.temporal = settings.antialiasing.jitter = false;
  settings.ambient.occlusion = false;
  return settings;
}

/// Mean of an RGBA buffer over `frames` frames.
std::vector<glm::dvec4> mean_signal(RendererRig& rig, const char* buffer, int frames) {
  std::vector<glm::dvec4> mean;
  for (int i = 0; i < frames; ++i) {
    rig.renderer.render();
    const render::FloatImage image = rig.capture(buffer);
    mean.resize(image.rgba.size() / 4);
    for (std::size_t p = 0; p < mean.size(); ++p) {
      for (int c = 0; c < 4; ++c) mean[p][c] += double(image.rgba[4 * p + c]) / frames;
    }
  }
  return mean;
}

glm::vec3 gradient_sky(const glm::vec3& d) {
  return glm::vec3(1.0f, 0.8f, 0.6f) + 0.5f * d.y + 0.3f * d.x;
}

std::shared_ptr<const scene::Scene> row_of_spheres(float metallic) {
  SceneBuilder builder;
  for (int i = 0; i < 5; ++i) {
    const float roughness = 0.25f * static_cast<float>(i);
    builder.place(builder.add_sphere(0.45f, surface(glm::vec3(1.0f), roughness, metallic)),
                  glm::translate(glm::mat4(1.0f), {static_cast<float>(i) - 2.0f, 0, 0}));
  }
  return builder.build();
}

// Energy conservation: in a furnace the demodulated signal equals the environment.
TEST(SpecularRays, MeanIsOneInFurnace) {
  for (const float metallic : {0.0f, 1.0f}) {
    RendererRig rig(row_of_spheres(metallic), scene::constant_environment(glm::vec3(1.0f)),
                    look({0, 0, 6}, {0, 0, 0}, 24.0f), 160, 40);
    protocol::Settings settings = undenoised_reflections();
    settings.lighting.direct = false;
    rig.apply(settings);
    const auto mean = mean_signal(rig, "specular.radiance", 64);
    const render::FloatImage instance = rig.capture("gbuffer.instance");
    std::vector<glm::dvec2> sums(6);
    for (std::size_t p = 0; p < mean.size(); ++p) {
      sums[static_cast<std::size_t>(instance.rgba[4 * p])] += glm::dvec2(mean[p].x, 1.0);
    }
    for (std::size_t id = 1; id < sums.size(); ++id) {
      EXPECT_GT(sums[id].y, 100);
      // At grazing angles some directions are above the shading horizon but below the triangle, and
      // contribute nothing.
      EXPECT_NEAR(sums[id].x / sums[id].y, 1.0, 0.015) << "sphere " << id << ", " << metallic;
    }
  }
}

TEST(SpecularRays, FurnaceImageIsWhite) {
  RendererRig rig(row_of_spheres(0.5f), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 24.0f), 160, 40);
  protocol::Settings settings = undenoised_reflections();
  settings.lighting.direct = false;
  settings.accumulation.max_samples = 64;
  rig.apply(settings);
  rig.accumulate(64);
  const render::FloatImage radiance = rig.capture("accumulated");
  for (std::size_t p = 0; p < radiance.rgba.size(); p += 4) {
    ASSERT_NEAR(radiance.rgba[p], 1.0f, 0.06f) << p / 4;
  }
}

// At normal incidence the prefilter's assumption N = V = R holds.
TEST(SpecularRays, ConvergeToPrefilteredEnvironmentAtNormalIncidence) {
  for (const float roughness : {0.0f, 0.25f, 0.5f, 1.0f}) {
    SceneBuilder builder;
    builder.place(builder.add_sphere(1.0f, surface(glm::vec3(1.0f), roughness, 1.0f)));
    RendererRig rig(builder.build(), make_environment(128, gradient_sky),
                    look({0, 0, 6}, {0, 0, 0}, 20.0f), 64, 64);
    protocol::Settings settings = undenoised_reflections();
    rig.apply(settings);
    const auto traced = mean_signal(rig, "hdr", 128);
    settings.specular.enabled = false;
    rig.apply(settings);
    const auto prefiltered = mean_signal(rig, "hdr", 1);
    glm::dvec3 a(0.0), b(0.0);
    for (int y = 28; y < 36; ++y) {
      for (int x = 28; x < 36; ++x) {
        a += glm::dvec3(traced[y * 64 + x]);
        b += glm::dvec3(prefiltered[y * 64 + x]);
      }
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1.0, 0.02) << roughness;
  }
}

/// A horizontal mirror seen from above, with a wall behind it.
struct MirrorAndWall {
  explicit MirrorAndWall(const shared::Material& wall, float roughness = 0.0f) {
    const auto mirror = surface(glm::vec3(1.0f), roughness, 1.0f);
    builder.place(builder.add_quad({{{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}}}, mirror));
    builder.place(builder.add_quad({{{-4, 0, -4}, {4, 0, -4}, {4, 8, -4}, {-4, 8, -4}}}, wall));
  }
  SceneBuilder builder;
  scene::Camera camera =
      look({0, 2, 4}, {0, 0, 0}, 30.0f);  // sees the base of the wall in the mirror
};

TEST(SpecularRays, MirrorShowsEmissiveWallUnchanged) {
  shared::Material wall = surface(glm::vec3(0.0f));
  wall.emissive = {3, 2, 1};
  MirrorAndWall scene(wall);
  RendererRig rig(scene.builder.build(), scene::constant_environment(glm::vec3(0.0f)), scene.camera,
                  64, 64);
  rig.apply(undenoised_reflections());
  rig.accumulate(1);
  const glm::vec3 middle = rgb(rig.capture("hdr"), 32, 32);
  EXPECT_NEAR(middle.x, 3.0f, 0.01f);
  EXPECT_NEAR(middle.y, 2.0f, 0.01f);
  EXPECT_NEAR(middle.z, 1.0f, 0.01f);
  // Distance from the mirror's center to the wall, 2 units up and 4 back.
  const render::FloatImage signal = rig.capture("specular.radiance");
  const float distance = signal.rgba[4 * (32 * 64 + 32) + 3];
  EXPECT_NEAR(distance, std::sqrt(4.0f * 4.0f + 2.0f * 2.0f), 0.15f);
}

TEST(SpecularRays, DirectLightReachesReflectedSurfaceUnlessOccluded) {
  const auto reflected_wall = [](bool blocked, protocol::HitShading shading, bool shadows) {
    MirrorAndWall scene(surface(glm::vec3(0.5f)));
    scene.builder.add_sun({0, 0, -1}, glm::vec3(4.0f));
    if (blocked) {
      scene.builder.place(scene.builder.add_quad({{{-9, -1, 6}, {9, -1, 6}, {9, 9, 6}, {-9, 9, 6}}},
                                                 surface(glm::vec3(0.0f))));
    }
    RendererRig rig(scene.builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                    scene.camera, 32, 32);
    protocol::Settings settings = undenoised_reflections();
    settings.specular.hit_shading = shading;
    settings.shadows.enabled = shadows;
    rig.apply(settings);
    rig.accumulate(1);
    return rgb(rig.capture("hdr"), 16, 16).x;
  };
  using protocol::HitShading;
  const float lit = reflected_wall(false, HitShading::traced, true);
  EXPECT_NEAR(lit, 4.0f * 0.5f / 3.14159f, 0.12f) << "about Lambert";
  EXPECT_EQ(reflected_wall(true, HitShading::traced, true), 0.0f);
  EXPECT_NEAR(reflected_wall(true, HitShading::traced, false), lit, 1e-5f);
  EXPECT_EQ(reflected_wall(false, HitShading::environment, true), 0.0f)
      << "analytic lights are disabled";
}

/// Number of pixels with a traced ray.
int traced_pixels(RendererRig& rig) {
  rig.accumulate(1);
  const render::FloatImage signal = rig.capture("specular.radiance");
  int count = 0;
  for (std::size_t i = 3; i < signal.rgba.size(); i += 4) count += signal.rgba[i] > 0.0f;
  return count;
}

TEST(SpecularRays, RoughAndUnlitSurfacesTraceNoRays) {
  shared::Material wall = surface(glm::vec3(1.0f));
  wall.flags |= shared::material_unlit;
  MirrorAndWall scene(wall, 0.5f);
  RendererRig rig(scene.builder.build(), scene::constant_environment(glm::vec3(1.0f)), scene.camera,
                  32, 32);
  protocol::Settings settings = undenoised_reflections();
  settings.specular.max_roughness = 0.5f;
  rig.apply(settings);
  EXPECT_GT(traced_pixels(rig), 100);
  settings.specular.max_roughness = 0.4f;
  rig.apply(settings);
  EXPECT_EQ(traced_pixels(rig), 0);
}

/// Spheres above a floor, scaled by `size`.
std::shared_ptr<const scene::Scene> spheres_on_floor(float size, float roughness) {
  SceneBuilder builder;
  const auto floor = surface(glm::vec3(0.6f, 0.5f, 0.4f), 0.3f);
  builder.place(builder.add_quad({{{-5 * size, 0, 5 * size},
                                   {5 * size, 0, 5 * size},
                                   {5 * size, 0, -5 * size},
                                   {-5 * size, 0, -5 * size}}},
                                 floor));
  const auto sphere =
      builder.add_sphere(0.8f * size, surface(glm::vec3(0.9f, 0.8f, 0.7f), roughness, 1.0f));
  for (const float x : {-1.0f, 1.0f}) {
    builder.place(sphere, glm::translate(glm::mat4(1.0f), glm::vec3(x, 0.9f, 0) * size));
  }
  builder.add_sun({0.3f, -1, -0.2f}, glm::vec3(3.0f), 2.0f);
  return builder.build();
}

scene::Camera floor_camera(float size) {
  scene::Camera camera = look(glm::vec3(0, 2.5f, 6) * size, glm::vec3(0, 0.7f, 0) * size, 30.0f);
  camera.near_plane *= size;
  return camera;
}

struct FloorRig : RendererRig {
  FloorRig(float size, const protocol::Settings& settings, std::uint32_t width = 96,
           std::uint32_t height = 64, const std::string& tracer = "auto")
      : RendererRig(spheres_on_floor(size, 0.2f), make_environment(128, gradient_sky),
                    floor_camera(size), width, height, tracer) {
    apply(settings);
  }
};

double mean_of(const render::FloatImage& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    sum += image.rgba[i] + image.rgba[i + 1] + image.rgba[i + 2];
  }
  return sum / static_cast<double>(image.rgba.size() / 4 * 3);
}

TEST(SpecularRays, ImageIsScaleInvariant) {
  FloorRig usual(1.0f, undenoised_reflections());
  const render::Frame expected = usual.accumulate(16);
  for (const float size : {0.01f, 100.0f}) {
    FloorRig scaled(size, undenoised_reflections());
    const std::string name = size < 1.0f ? "specular_small_scene" : "specular_large_scene";
    expect_similar(name, expected, scaled.accumulate(16), 0.35, 0.99);
  }
}

/// Number of pixels of a buffer that differ, and the largest difference.
std::pair<int, double> differing(RendererRig& one, RendererRig& other, const char* buffer) {
  const auto a = one.capture(buffer).rgba, b = other.capture(buffer).rgba;
  int count = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    count += a[i] != b[i];
    most = std::max(most, std::abs(double(a[i]) - double(b[i])));
  }
  return {count, most};
}

// Sorting changes the neighbors of a ray, and texture filters of some drivers round depending on
// neighboring lanes: radiance may differ in the last bit, the output image must not.
TEST(SpecularRays, SortedRaysGiveSameImage) {
  for (const std::string& tracer : supported_tracers()) {
    protocol::Settings settings = undenoised_reflections();
    FloorRig plain(1.0f, settings, 96, 64, tracer);
    const render::Frame expected = plain.accumulate(3);
    settings.specular.sort_rays = true;
    FloorRig sorted(1.0f, settings, 96, 64, tracer);
    const render::Frame actual = sorted.accumulate(3);
    EXPECT_EQ(expected.rgba, actual.rgba) << tracer;
    const auto [count, most] = differing(plain, sorted, "specular.radiance");
    EXPECT_LE(count, 60) << tracer;
    EXPECT_LE(most, 1e-6) << tracer;
  }
}

TEST(SpecularRays, TracersAgreeOnTheMean) {
  FloorRig one(1.0f, undenoised_reflections()),
      other(1.0f, undenoised_reflections(), 96, 64, "software");
  one.accumulate(8);
  other.accumulate(8);
  EXPECT_NEAR(mean_of(one.capture("accumulated")) / mean_of(other.capture("accumulated")), 1.0,
              2e-3);
}

TEST(SpecularRays, HalfResolutionMatchesFullResolutionMean) {
  protocol::Settings settings = undenoised_reflections();
  FloorRig whole(1.0f, settings);
  const render::Frame expected = whole.accumulate(64);
  settings.specular.half_resolution = true;
  FloorRig half(1.0f, settings);
  const render::Frame actual = half.accumulate(64);
  save_image("specular_half", actual);
  expect_similar("specular_half_resolution", expected, actual, 2.0, 0.97);
  EXPECT_NEAR(mean_of(half.capture("accumulated")) / mean_of(whole.capture("accumulated")), 1.0,
              0.02);
}

TEST(SpecularRays, HalfResolutionFurnaceIsWhite) {
  RendererRig rig(row_of_spheres(1.0f), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 6}, {0, 0, 0}, 24.0f), 161, 41);
  protocol::Settings settings = undenoised_reflections();
  settings.lighting.direct = false;
  settings.specular.half_resolution = true;
  rig.apply(settings);
  rig.accumulate(4);
  const render::FloatImage radiance = rig.capture("accumulated");
  for (std::size_t p = 0; p < radiance.rgba.size(); p += 4) {
    ASSERT_NEAR(radiance.rgba[p], 1.0f, 0.03f) << p / 4;
  }
}

class OddSizes : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(OddSizes, AllPixelsAreFinite) {
  const auto [width, height] = GetParam();
  for (const bool half : {false, true}) {
    protocol::Settings settings = undenoised_reflections();
    settings.specular.half_resolution = half;
    settings.specular.sort_rays = true;
    FloorRig rig(1.0f, settings, width, height);
    rig.accumulate(1);
    const render::FloatImage hdr = rig.capture("hdr");
    ASSERT_EQ(hdr.rgba.size(), std::size_t(width) * height * 4);
    for (const float value : hdr.rgba) ASSERT_TRUE(std::isfinite(value));
    EXPECT_GT(mean_of(hdr), 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, OddSizes,
                         testing::Values(std::pair(1, 1), std::pair(17, 31),
                                         std::pair(1919, 1079)));

// A NaN sample must not reach the signal, because filters would spread it.
TEST(SpecularRays, NaNSampleBecomesBlack) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  shared::Material wall = surface(glm::vec3(0.0f));
  wall.emissive = {nan, std::numeric_limits<float>::infinity(), 1};
  MirrorAndWall scene(wall);
  scene::Environment sky = make_environment(32, gradient_sky);
  sky.radiance[100] = glm::vec3(nan);
  RendererRig rig(scene.builder.build(), sky, scene.camera, 32, 32);
  rig.apply(undenoised_reflections());
  rig.accumulate(2);
  for (const char* buffer : {"specular.radiance", "hdr", "accumulated"}) {
    const render::FloatImage image = rig.capture(buffer);
    for (const float value : image.rgba) ASSERT_TRUE(std::isfinite(value)) << buffer;
  }
  EXPECT_EQ(rgb(rig.capture("hdr"), 16, 16), glm::vec3(0.0f));
}

}  // namespace
}  // namespace heliograph::test
