#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/still.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 160, height = 90;

/// Soft shadows, a matt ball and a nearly smooth metal one, on a ground that mirrors a little.
std::shared_ptr<const scene::Scene> things() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface({0.6f, 0.55f, 0.5f}, 0.4f)));
  builder.place(builder.add_sphere(0.8f, surface({0.8f, 0.2f, 0.1f}, 0.8f)),
                glm::translate(glm::mat4(1.0f), {-0.9f, 0.8f, 0}));
  builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.8f, 0.6f}, 0.15f, 1.0f)),
                glm::translate(glm::mat4(1.0f), {0.8f, 0.6f, 0.5f}));
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 8.0f);
  return builder.build();
}

/// A sky with one bright side, so that turning it is a light that moves.
glm::vec3 sky(const glm::vec3& d) {
  return glm::vec3(0.4f, 0.5f, 0.7f) + (d.x > 0.8f ? glm::vec3(4.0f, 3.0f, 2.0f) : glm::vec3(0.0f));
}

scene::Camera eye() {
  return look({0.5f, 2, 4.5f}, {0, 0.5f, 0});
}

/// What is shown is the denoised frame alone.
protocol::Settings denoised_alone() {
  protocol::Settings settings;
  settings.antialiasing.jitter = settings.antialiasing.temporal = false;
  settings.accumulation.handover = 4096;
  settings.accumulation.max_samples = 4096;
  return settings;
}

protocol::Settings raw_alone() {
  protocol::Settings settings = denoised_alone();
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.accumulation.handover = 0;
  settings.sampling.seed = 5;
  return settings;
}

class Things : public Still {
 public:
  explicit Things(const protocol::Settings& settings)
      : Still(things(), make_environment(64, sky), eye(), width, height) {
    apply(settings);
  }
};

render::Frame truth_from(const scene::Camera& camera, float rotation = 0.0f) {
  protocol::Settings settings = raw_alone();
  settings.environment.rotation = rotation;
  Things still(settings);
  still.renderer.set_camera(camera);
  return still.accumulate(192);
}

TEST(RestingView, FlickersEverLessAndNearsTheTruth) {
  const render::Frame truth = truth_from(eye());
  Things still(denoised_alone());
  render::Frame before = still.renderer.render(), now;
  double early = 0.0, late = 0.0;
  for (int i = 2; i <= 48; ++i) {
    now = still.renderer.render();
    const double change = difference(before, now).mean;
    if (i <= 5) early = std::max(early, change);
    if (i > 44) late = std::max(late, change);
    before = now;
  }
  save_picture("denoised_resting", now);
  save_picture("denoised_resting_truth", truth);
  EXPECT_LT(late, 0.2 * early);
  EXPECT_LT(late, 0.3) << "code values of 255";
  EXPECT_LT(difference(truth, now).mean, 2.4);
  EXPECT_GT(ssim(truth, now), 0.955);
}

TEST(RestingView, ChangesNoBrightness) {
  Things raw(raw_alone()), denoised(denoised_alone());
  raw.accumulate(192);
  denoised.accumulate(32);
  const double expected = mean_luminance(raw.capture("accumulated"));
  EXPECT_NEAR(mean_luminance(denoised.capture("hdr")), expected, 0.01 * expected);
}

scene::Camera yawed(int frame) {
  scene::Camera camera = eye();
  const float angle = glm::radians(0.7f * static_cast<float>(frame));
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, {0, 1, 0});
  camera.target = camera.eye + glm::vec3(turn * glm::vec4(camera.target - camera.eye, 0));
  return camera;
}

scene::Camera pitched(int frame) {
  scene::Camera camera = eye();
  const float angle = glm::radians(0.5f * static_cast<float>(frame));
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, {1, 0, 0});
  camera.target = camera.eye + glm::vec3(turn * glm::vec4(camera.target - camera.eye, 0));
  return camera;
}

scene::Camera dollied(int frame) {
  scene::Camera camera = eye();
  camera.eye += (camera.target - camera.eye) * (0.012f * static_cast<float>(frame));
  return camera;
}

struct Movement {
  const char* name;
  scene::Camera (*camera)(int frame);
};

class MovingView : public testing::TestWithParam<Movement> {};

INSTANTIATE_TEST_SUITE_P(Ways, MovingView,
                         testing::Values(Movement{"yaw", yawed}, Movement{"pitch", pitched},
                                         Movement{"dolly", dollied}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// A mirrored axis anywhere in the motion is invisible at rest and shows in one of the three.
TEST_P(MovingView, HasLittleOfTheNoiseOfOneSample) {
  const int frames = 16;
  Things still(denoised_alone()), raw(raw_alone());
  render::Frame shown, noisy;
  for (int i = 0; i < frames; ++i) {
    still.renderer.set_camera(GetParam().camera(i));
    shown = still.renderer.render();
  }
  raw.renderer.set_camera(GetParam().camera(frames - 1));
  noisy = raw.renderer.render();
  const render::Frame truth = truth_from(GetParam().camera(frames - 1));
  save_picture(std::string("denoised_") + GetParam().name, shown);
  save_picture(std::string("denoised_") + GetParam().name + "_truth", truth);
  EXPECT_LT(difference(truth, shown).mean, 0.3 * difference(truth, noisy).mean);
  EXPECT_GT(ssim(truth, shown), 0.94);
  EXPECT_LT(ssim(truth, noisy), ssim(truth, shown) - 0.1);
}

/// Error against the truth after the sky has turned for some frames.
double error_under_a_turning_sky(protocol::Rectification mode, const char* name) {
  protocol::Settings settings = denoised_alone();
  settings.shadow_temporal.rectification = settings.specular_temporal.rectification = mode;
  Things still(settings);
  render::Frame shown;
  for (int i = 0; i < 24; ++i) {
    settings.environment.rotation = static_cast<float>(std::max(i - 12, 0)) * 8.0f;
    still.apply(settings);
    shown = still.renderer.render();
  }
  save_picture(name, shown);
  return difference(truth_from(eye(), settings.environment.rotation), shown).mean;
}

TEST(MovingLight, LeavesLessOfAGhostWithTheFastHistoryThanWithout) {
  const double off = error_under_a_turning_sky(protocol::Rectification::off, "turning_off");
  const double fast =
      error_under_a_turning_sky(protocol::Rectification::fast_history, "turning_fast_history");
  EXPECT_LT(fast, 0.95 * off);
}

}  // namespace
}  // namespace heliograph::test
