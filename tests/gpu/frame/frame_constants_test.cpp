#include "render/frame/frame_constants.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{64, 36};

class FrameConstants : public testing::Test {
 protected:
  shared::FrameConstants make(const scene::Camera& camera, std::uint32_t sample,
                              const shared::FrameConstants* before = nullptr) {
    return render::make_frame_constants(camera, settings_, rig_.moving(), {extent, extent}, sample,
                                        before);
  }
  scene::Camera camera_ = look({1, 2, 5}, {0, 0.5f, 0}, 50.0f);
  FrameRig rig_{SceneBuilder().build(), camera_, {.extent = extent}};
  protocol::Settings settings_;
};

TEST_F(FrameConstants, JitterShiftsProjectionBySampleOffset) {
  const auto still = make(camera_, 0), moved = make(camera_, 5);
  const glm::vec2 offset = render::sample_jitter(5);
  const glm::vec4 world(0.3f, 0.2f, -1.0f, 1.0f);
  const auto pixel = [&](const glm::mat4& matrix) {
    const glm::vec4 clip = matrix * world;
    return (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(extent.width, extent.height);
  };
  EXPECT_LE(glm::distance(pixel(moved.view_projection) - pixel(still.view_projection), offset),
            1e-4f);
  EXPECT_EQ(moved.unjittered, still.unjittered);
  settings_.antialiasing.jitter = false;
  EXPECT_EQ(make(camera_, 5).view_projection, still.view_projection);
}

TEST_F(FrameConstants, TexturesAreSeenByThePixelsShown) {
  const auto footprint = [&](VkExtent2D shown) {
    return render::make_frame_constants(camera_, settings_, rig_.moving(), {extent, shown}, 0,
                                        nullptr)
        .texture_footprint;
  };
  EXPECT_FLOAT_EQ(footprint(extent), 1.0f);
  EXPECT_FLOAT_EQ(footprint({96, 54}), 36.0f / 54.0f);
}

TEST_F(FrameConstants, PreviousMatricesAreThoseOfPreviousFrame) {
  const auto first = make(camera_, 0);
  EXPECT_EQ(first.previous_unjittered, first.unjittered);
  EXPECT_EQ(first.previous_view, first.view);
  const auto second = make(look({2, 2, 5}, {0, 0, 0}), 1, &first);
  EXPECT_EQ(second.previous_unjittered, first.unjittered);
  EXPECT_EQ(second.previous_view, first.view);
  EXPECT_NE(second.view, first.view);
}

TEST_F(FrameConstants, ContainSettings) {
  settings_.environment.intensity = 2.5f;
  settings_.environment.rotation = 90.0f;
  EXPECT_FLOAT_EQ(make(camera_, 9).background_intensity, 2.5f);
  settings_.background.show = protocol::BackgroundKind::color;
  settings_.ambient.radius = 3.0f;
  settings_.exposure.compensation = 3.0f;
  settings_.sampling.seed = 42;
  settings_.shadows.enabled = false;
  const auto constants = make(camera_, 9);
  EXPECT_FLOAT_EQ(constants.environment_intensity, 2.5f);
  EXPECT_FLOAT_EQ(constants.background_intensity, 1.0f) << "it is no part of the environment";
  EXPECT_NEAR(constants.environment_cos, 0.0f, 1e-6f);
  EXPECT_FLOAT_EQ(constants.environment_sin, 1.0f);
  EXPECT_FLOAT_EQ(constants.ambient_radius, 3.0f);
  EXPECT_FLOAT_EQ(constants.exposure_factor, 8.0f);
  EXPECT_LT(constants.directional_light_radius, 0.0f) << "every light's own diameter";
  EXPECT_EQ(constants.extent, glm::uvec2(64, 36));
  EXPECT_EQ(constants.sample_index, 9u);
  EXPECT_EQ(constants.seed, 42u);
  EXPECT_EQ(constants.flags & shared::frame_shadows, 0u);
  EXPECT_NE(constants.flags & shared::frame_direct, 0u);
  settings_.shadows.angular_diameter_override = 10.0f;
  EXPECT_NEAR(make(camera_, 9).directional_light_radius, std::tan(glm::radians(5.0f)), 1e-6f);
}

}  // namespace
}  // namespace heliograph::test
