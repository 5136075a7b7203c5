// The frame as a whole, every denoiser on: what a single pass cannot show.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "tests/image/support/scene_renderer.hpp"

namespace heliograph::test {
namespace {

glm::vec3 sky(const glm::vec3& d) {
  return glm::vec3(0.5f, 0.6f, 0.8f) + glm::vec3(0.3f, 0.2f, 0.1f) * d.y + 0.2f * d.x;
}

float luminance(const glm::vec3& color) {
  return glm::dot(color, {0.2126f, 0.7152f, 0.0722f});
}

/// Soft shadows, a rough ball and a nearly smooth metal one on a floor that mirrors, `size` metres
/// to the unit.
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

struct Scaled : Still {
  explicit Scaled(float size, const protocol::Settings& settings, std::uint32_t width = 96,
                  std::uint32_t height = 54, const std::string& tracer = "auto")
      : Still(still_life(size), make_environment(64, sky), eye(size, 0), width, height, tracer) {
    apply(settings);
  }
};

protocol::Settings sized(float size) {
  protocol::Settings settings;
  settings.ambient.radius *= size;
  settings.accumulation.max_samples = 4096;
  settings.accumulation.blend_samples = 4096;  // what is shown is the denoised frame
  return settings;
}

void expect_numbers(Still& still, const std::string& what) {
  for (const render::BufferInfo& buffer : still.renderer.buffers()) {
    const render::FloatImage image = still.capture(buffer.name.c_str());
    const auto bad = std::count_if(image.rgba.begin(), image.rgba.end(),
                                   [](float value) { return !std::isfinite(value); });
    EXPECT_EQ(bad, 0) << buffer.name << ", " << what;
  }
}

TEST(WholeFrame, DoesNotDependOnTheSizeOfTheScene) {
  const auto play = [](float size) {
    Scaled moving(size, sized(size));
    render::Frame frame;
    for (int i = 0; i < 10; ++i) {
      moving.renderer.set_camera(eye(size, i));
      frame = moving.renderer.render();
    }
    return std::pair(frame, moving.capture("denoise.reprojection"));
  };
  const auto [expected, expected_map] = play(1.0f);
  for (const float size : {0.01f, 100.0f}) {
    const auto [frame, map] = play(size);
    save_picture(size < 1.0f ? "whole_frame_small" : "whole_frame_large", frame);
    const Difference apart = difference(expected, frame);
    EXPECT_LT(apart.mean, 0.5) << "code values, scene x " << size;
    EXPECT_GT(ssim(expected, frame), 0.985) << size;
    std::size_t other = 0;  // pixels whose history is found in one and not in the other
    for (std::size_t i = 3; i < map.rgba.size(); i += 4) {
      other += map.rgba[i] != expected_map.rgba[i];
    }
    EXPECT_LT(other, map.rgba.size() / 4 / 200) << "scene x " << size;
  }
}

/// A way to make the frame: the tracer, who finds the first surfaces, and settings that differ.
struct Way {
  const char* name;
  const char* tracer;
  protocol::PrimaryVisibility source;
  void (*change)(protocol::Settings& settings);
};

void as_it_is(protocol::Settings&) {}

void everything_else(protocol::Settings& s) {
  s.shadow_temporal.rectification = s.specular_temporal.rectification =
      protocol::Rectification::percentile;
  s.shadow_blur.kernel = s.specular_blur.kernel = protocol::BlurKernel::full;
  s.shadow_blur.feedback = s.specular_blur.feedback = 0;
  s.reinhard.mode = protocol::Reinhard::exact;
  s.specular.half_resolution = s.specular.sort_rays = true;
  s.exposure.mode = protocol::ExposureMode::automatic;
}

class WholeFrameSizes : public testing::TestWithParam<Way> {};

INSTANTIATE_TEST_SUITE_P(
    Ways, WholeFrameSizes,
    testing::Values(Way{"best", "auto", protocol::PrimaryVisibility::rays, as_it_is},
                    Way{"software", "software", protocol::PrimaryVisibility::raster, as_it_is},
                    Way{"others", "auto", protocol::PrimaryVisibility::raster, everything_else}),
    [](const auto& tested) { return std::string(tested.param.name); });

// Rows and columns that no group of 8 x 8 fills, a picture that is all border, and one above 1080p
// but for a pixel. The validation layers watch.
TEST_P(WholeFrameSizes, OddOnesAreWholeAndAllNumbers) {
  protocol::Settings settings = sized(1.0f);
  settings.gbuffer.source = GetParam().source;
  GetParam().change(settings);
  const bool large = std::string(GetParam().name) == "best";
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{1, 1}, {17, 31}, {203, 5}};
  if (large) sizes.emplace_back(1919, 1079);
  for (const auto& [width, height] : sizes) {
    Scaled still(1.0f, settings, width, height, GetParam().tracer);
    render::Frame frame;
    for (int i = 0; i < 2; ++i) {
      still.renderer.set_camera(eye(1.0f, i));
      frame = still.renderer.render();
    }
    ASSERT_EQ(frame.rgba.size(), std::size_t{4} * width * height);
    if (width < 300) expect_numbers(still, std::to_string(width));
    // The last row and column are as bright as those before them.
    const render::FloatImage hdr = still.capture("hdr");
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

// A surface whose light is no number, and what mirrors it: forgotten once out of view.
TEST(WholeFrame, WhatIsNoNumberNeitherSpreadsNorStays) {
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
  Still still(scene, make_environment(64, sky), camera(0), 96, 54);
  still.apply(sized(1.0f));
  for (int i = 0; i < 4; ++i) still.renderer.render();
  for (const char* signal : {"visibility.denoised", "specular.denoised", "hdr", "hdr_raw",
                             "antialiased", "accumulated"}) {
    const render::FloatImage image = still.capture(signal);
    for (const float value : image.rgba) ASSERT_TRUE(std::isfinite(value)) << signal;
  }
  // Beside it nothing is black; and a few frames later nothing tells that it was there.
  EXPECT_GT(luminance(rgb(still.capture("hdr"), 8, 50)), 0.05f);
  for (int i = 1; i <= 8; ++i) {
    still.renderer.set_camera(camera(0.75f * static_cast<float>(i)));
    still.renderer.render();
  }
  Still fresh(scene, make_environment(64, sky), camera(6.0f), 96, 54);
  fresh.apply(sized(1.0f));
  render::Frame expected, actual;
  for (int i = 0; i < 24; ++i) {
    expected = fresh.renderer.render();
    actual = still.renderer.render();
  }
  save_picture("after_no_numbers", actual);
  EXPECT_LT(difference(expected, actual).mean, 0.5);
  EXPECT_LT(difference(expected, actual).maximum, 24.0);
}

// What is seen, and its light, jump up by four orders of magnitude and back.
TEST(WholeFrame, FollowsAHugeStepOfLightUpAndDown) {
  protocol::Settings dark = sized(1.0f), bright = dark;
  bright.environment.intensity = 100.0f;
  const auto world = make_environment(64, [](const glm::vec3& d) { return 100.0f * sky(d); });
  const auto mean = [](Still& still) { return mean_luminance(still.capture("hdr")); };
  const auto settle = [](Still& still, const protocol::Settings& settings, int frames) {
    still.apply(settings);
    for (int i = 0; i < frames; ++i) still.renderer.render();
  };
  const auto truth = [&](const protocol::Settings& settings) {
    Still fresh(still_life(1.0f), world, eye(1.0f, 0), 64, 36);
    settle(fresh, settings, 64);
    return mean(fresh);
  };
  const double low = truth(dark), high = truth(bright);
  EXPECT_GT(high, 3000.0) << "16 bit floats hold 65504: not the square of this";
  Still still(still_life(1.0f), world, eye(1.0f, 0), 64, 36);
  settle(still, dark, 64);
  settle(still, bright, 64);
  EXPECT_NEAR(mean(still), high, 0.01 * high);
  settle(still, dark, 64);
  EXPECT_NEAR(mean(still), low, 1e-3 * high) << "next to nothing of the light before is left";
}

}  // namespace
}  // namespace heliograph::test
