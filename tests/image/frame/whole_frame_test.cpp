// Whole frames with all denoisers: properties that tests of single passes cannot cover.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

glm::vec3 frame_sky(const glm::vec3& d) {
  return glm::vec3(0.5f, 0.6f, 0.8f) + glm::vec3(0.3f, 0.2f, 0.1f) * d.y + 0.2f * d.x;
}

float luminance(const glm::vec3& color) {
  return glm::dot(color, {0.2126f, 0.7152f, 0.0722f});
}

/// A rough and a nearly smooth metal sphere on a glossy floor, with soft shadows, scaled by `size`.
std::shared_ptr<const scene::Scene> still_life(float size) {
  SceneBuilder builder;
  const glm::mat4 scale = glm::scale(glm::mat4(1.0f), glm::vec3(size));
  const auto at = [&](float x, float y, float z) { return glm::translate(scale, {x, y, z}); };
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface({0.6f, 0.55f, 0.5f}, 0.3f)),
                scale);
  builder.place(builder.add_sphere(0.8f, surface({0.8f, 0.2f, 0.1f}, 0.8f)), at(-0.9f, 0.8f, 0));
  builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.8f, 0.6f}, 0.15f, 1.0f)),
                at(0.8f, 0.6f, 0.5f));
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 8.0f);
  return builder.build();
}

scene::Camera eye(float size, int frame) {
  const float step = 0.02f * static_cast<float>(frame);
  scene::Camera camera =
      look(glm::vec3(0.5f + step, 2, 4.5f - 2.0f * step) * size, glm::vec3(0, 0.5f, 0) * size);
  camera.near_plane *= size;
  return camera;
}

struct ScaledRig : RendererRig {
  explicit ScaledRig(float size, const protocol::Settings& settings, std::uint32_t width = 96,
                     std::uint32_t height = 54, const std::string& tracer = "auto")
      : RendererRig(still_life(size), make_environment(64, frame_sky), eye(size, 0), width, height,
                    tracer) {
    apply(settings);
  }
};

protocol::Settings scaled_settings(float size) {
  protocol::Settings settings;
  settings.ambient.radius *= size;
  settings.accumulation.max_samples = 4096;
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 4096;  // shows the denoised frame
  return settings;
}

void expect_finite(RendererRig& rig, const std::string& what) {
  for (const render::BufferInfo& buffer : rig.renderer.buffers()) {
    const render::FloatImage image = rig.capture(buffer.name.c_str());
    const auto bad = std::count_if(image.rgba.begin(), image.rgba.end(),
                                   [](float value) { return !std::isfinite(value); });
    EXPECT_EQ(bad, 0) << buffer.name << ", " << what;
  }
}

TEST(WholeFrame, IsScaleInvariant) {
  const auto play = [](float size) {
    ScaledRig moving(size, scaled_settings(size));
    render::Frame frame;
    for (int i = 0; i < 10; ++i) {
      moving.renderer.set_camera(eye(size, i));
      frame = moving.renderer.render();
    }
    return std::pair(frame, moving.capture("reproject.motion"));
  };
  const auto [expected, expected_map] = play(1.0f);
  for (const float size : {0.01f, 100.0f}) {
    const auto [frame, map] = play(size);
    save_image(size < 1.0f ? "whole_frame_small" : "whole_frame_large", frame);
    const Difference error = difference(expected, frame);
    EXPECT_LT(error.mean, 0.5) << "code values, scene x " << size;
    EXPECT_GT(ssim(expected, frame), 0.985) << size;
    std::size_t other = 0;  // pixels with history in one scale only
    for (std::size_t i = 3; i < map.rgba.size(); i += 4) {
      other += map.rgba[i] != expected_map.rgba[i];
    }
    EXPECT_LT(other, map.rgba.size() / 4 / 200) << "scene x " << size;
  }
}

/// A configuration of the renderer: tracer, source of primary visibility and settings.
struct Configuration {
  const char* name;
  const char* tracer;
  protocol::PrimaryVisibility source;
  void (*change)(protocol::Settings& settings);
};

void defaults(protocol::Settings&) {}

void other_settings(protocol::Settings& s) {
  s.shadow_temporal.rectification = s.specular_temporal.rectification =
      protocol::Rectification::percentile;
  s.shadow_blur.kernel = s.specular_blur.kernel = protocol::BlurKernel::full;
  s.shadow_blur.feedback = s.specular_blur.feedback = 0;
  s.reinhard.mode = protocol::Reinhard::exact;
  s.specular.half_resolution = s.specular.sort_rays = true;
  s.exposure.mode = protocol::ExposureMode::automatic;
}

void half_resolution(protocol::Settings& s) {
  s.shadow_blur.half_resolution = true;
}

class WholeFrameSizes : public testing::TestWithParam<Configuration> {};

INSTANTIATE_TEST_SUITE_P(
    Configurations, WholeFrameSizes,
    testing::Values(
        Configuration{"best", "auto", protocol::PrimaryVisibility::rays, defaults},
        Configuration{"software", "software", protocol::PrimaryVisibility::raster, defaults},
        Configuration{"others", "auto", protocol::PrimaryVisibility::raster, other_settings},
        Configuration{"half", "auto", protocol::PrimaryVisibility::raster, half_resolution}),
    [](const auto& tested) { return std::string(tested.param.name); });

// Sizes that are no multiple of the 8 x 8 workgroup, 1 x 1, and one pixel short of 1080p; with
// validation layers.
TEST_P(WholeFrameSizes, OddSizesAreCompleteAndFinite) {
  protocol::Settings settings = scaled_settings(1.0f);
  settings.gbuffer.source = GetParam().source;
  GetParam().change(settings);
  const bool large = std::string(GetParam().name) == "best";
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{1, 1}, {17, 31}, {203, 5}};
  if (large) sizes.emplace_back(1919, 1079);
  for (const auto& [width, height] : sizes) {
    ScaledRig rig(1.0f, settings, width, height, GetParam().tracer);
    render::Frame frame;
    for (int i = 0; i < 2; ++i) {
      rig.renderer.set_camera(eye(1.0f, i));
      frame = rig.renderer.render();
    }
    ASSERT_EQ(frame.rgba.size(), std::size_t{4} * width * height);
    if (width < 300) expect_finite(rig, std::to_string(width));
    // The last row and column are as bright as those before them.
    const render::FloatImage hdr = rig.capture("hdr");
    for (const float value : hdr.rgba) ASSERT_TRUE(std::isfinite(value));
    for (std::uint32_t x = 0; x < width; ++x) {
      ASSERT_GT(luminance(rgb(hdr, x, height - 1)), 0.02f) << x << " of " << width;
    }
    for (std::uint32_t y = 0; y < height; ++y) {
      ASSERT_GT(luminance(rgb(hdr, width - 1, y)), 0.02f) << y << " of " << height;
    }
  }
  EXPECT_EQ(validation_messages(), 0u);
}

// A surface with NaN emission and its reflection leave no trace once out of view.
TEST(WholeFrame, NaNsNeitherSpreadNorPersist) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  shared::Material bad = surface(glm::vec3(0.5f));
  bad.emissive = {nan, 1.0f, std::numeric_limits<float>::infinity()};
  bad.flags = shared::material_double_sided;
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-90, 0, 9}, {90, 0, 9}, {90, 0, -9}, {-90, 0, -9}}},
                                 surface({0.6f, 0.55f, 0.5f}, 0.2f)));
  builder.place(builder.add_quad({{{-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 1, 0}}}, bad));
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 8.0f);
  const auto scene = builder.build();
  const auto camera = [](float x) { return look({x, 1.5f, 4}, {x, 0.4f, 0}); };
  RendererRig rig(scene, make_environment(64, frame_sky), camera(0), 96, 54);
  rig.apply(scaled_settings(1.0f));
  for (int i = 0; i < 4; ++i) rig.renderer.render();
  for (const char* signal : {"visibility.denoised", "specular.denoised", "hdr", "hdr.noisy",
                             "temporal_antialias", "accumulated"}) {
    const render::FloatImage image = rig.capture(signal);
    for (const float value : image.rgba) ASSERT_TRUE(std::isfinite(value)) << signal;
  }
  // Neighbors are not black, and a few frames later the NaN surface has no effect.
  EXPECT_GT(luminance(rgb(rig.capture("hdr"), 8, 50)), 0.05f);
  for (int i = 1; i <= 8; ++i) {
    rig.renderer.set_camera(camera(0.75f * static_cast<float>(i)));
    rig.renderer.render();
  }
  RendererRig fresh(scene, make_environment(64, frame_sky), camera(6.0f), 96, 54);
  fresh.apply(scaled_settings(1.0f));
  render::Frame expected, actual;
  for (int i = 0; i < 24; ++i) {
    expected = fresh.renderer.render();
    actual = rig.renderer.render();
  }
  save_image("after_nan", actual);
  EXPECT_LT(difference(expected, actual).mean, 0.5);
  EXPECT_LT(difference(expected, actual).maximum, 24.0);
}

// Background and lighting step up by four orders of magnitude and back.
TEST(WholeFrame, FollowsHdrStepUpAndDown) {
  protocol::Settings dark = scaled_settings(1.0f), bright = dark;
  bright.environment.intensity = 100.0f;
  const auto world = make_environment(64, [](const glm::vec3& d) { return 100.0f * frame_sky(d); });
  const auto mean = [](RendererRig& rig) { return mean_luminance(rig.capture("hdr")); };
  const auto settle = [](RendererRig& rig, const protocol::Settings& settings, int frames) {
    rig.apply(settings);
    for (int i = 0; i < frames; ++i) rig.renderer.render();
  };
  const auto reference = [&](const protocol::Settings& settings) {
    RendererRig fresh(still_life(1.0f), world, eye(1.0f, 0), 64, 36);
    settle(fresh, settings, 64);
    return mean(fresh);
  };
  const double low = reference(dark), high = reference(bright);
  EXPECT_GT(high, 3000.0) << "its square must exceed the half float maximum of 65504";
  RendererRig rig(still_life(1.0f), world, eye(1.0f, 0), 64, 36);
  settle(rig, dark, 64);
  settle(rig, bright, 64);
  EXPECT_NEAR(mean(rig), high, 0.01 * high);
  settle(rig, dark, 64);
  EXPECT_NEAR(mean(rig), low, 1e-3 * high) << "residue of the bright phase";
}

}  // namespace
}  // namespace heliograph::test
