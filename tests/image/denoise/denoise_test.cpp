#include <gtest/gtest.h>

#include <algorithm>

#include "tests/image/denoise/spheres.hpp"

namespace heliograph::test {
namespace {

TEST(StaticView, FlickerDecreasesAndConvergesToGroundTruth) {
  const render::Frame reference = ground_truth_from(spheres_camera());
  SpheresRig rig(denoised_only());
  render::Frame before = rig.renderer.render(), now;
  double early = 0.0, late = 0.0;
  for (int i = 2; i <= 48; ++i) {
    now = rig.renderer.render();
    const double change = difference(before, now).mean;
    if (i <= 5) early = std::max(early, change);
    if (i > 44) late = std::max(late, change);
    before = now;
  }
  save_image("denoised_static", now);
  save_image("denoised_static_ground_truth", reference);
  EXPECT_LT(late, 0.15 * early);
  EXPECT_LT(late, 0.22) << "code values of 255";
  EXPECT_LT(difference(reference, now).mean, 0.75);
  EXPECT_GT(ssim(reference, now), 0.985);
}

/// With everything that changes between frames: jitter, antialiasing and accumulation. `most`: mean
/// and maximum of what a frame changes in the end, code values of 255.
void expect_constant(bool indirect, double most_mean, double most) {
  protocol::Settings settings;
  settings.indirect.enabled = indirect;
  settings.accumulation.max_samples = 4096;
  settings.accumulation.by_noise = false;
  SpheresRig rig(settings);
  render::Frame before, now;
  const auto change_after = [&](std::uint32_t samples) {
    before = rig.accumulate(samples);
    now = rig.renderer.render();
    return difference(before, now);
  };
  const double early = change_after(32).mean, middle = change_after(96).mean;
  const Difference late = change_after(288);
  EXPECT_LT(middle, 0.6 * early) << "error is proportional to 1 / samples: a third";
  EXPECT_LT(late.mean, 0.5 * middle);
  EXPECT_LT(late.mean, most_mean);
  EXPECT_LE(late.maximum, most);
}

TEST(StaticView, ConvergesToConstantImage) {
  expect_constant(false, 0.035, 2.0);
}
TEST(StaticView, ConvergesToConstantImageWithIndirectLight) {
  expect_constant(true, 0.05, 3.0);
}

// Where noise decides how much of the mean is shown, its share changes a little, too.
TEST(StaticView, ChangesLessWhereNoiseDecides) {
  const auto changes = [](bool by_noise) {
    protocol::Settings settings;
    settings.accumulation.max_samples = 4096;
    settings.accumulation.by_noise = by_noise;
    settings.indirect.path_guiding = false;  // which still learns during the first samples
    SpheresRig rig(settings);
    std::vector<double> means;
    for (const std::uint32_t samples : {4u, 32u, 96u, 288u}) {
      const render::Frame before = rig.accumulate(samples);
      means.push_back(difference(before, rig.renderer.render()).mean);
    }
    return means;
  };
  const std::vector<double> by_count = changes(false), by_noise = changes(true);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(by_noise[i], by_count[i]) << i;
  EXPECT_LT(by_noise[3], 0.035) << "code values of 255";
}

TEST(StaticView, DenoisingPreservesMeanLuminance) {
  SpheresRig raw(noisy_only()), denoised(denoised_only());
  raw.accumulate(192);
  denoised.accumulate(32);
  const double expected = mean_luminance(raw.capture("accumulated"));
  EXPECT_NEAR(mean_luminance(denoised.capture("hdr")), expected, 0.01 * expected);
}

scene::Camera yawed(int frame) {
  scene::Camera camera = spheres_camera();
  const float angle = glm::radians(0.7f * static_cast<float>(frame));
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, {0, 1, 0});
  camera.target = camera.eye + glm::vec3(turn * glm::vec4(camera.target - camera.eye, 0));
  return camera;
}

scene::Camera pitched(int frame) {
  scene::Camera camera = spheres_camera();
  const float angle = glm::radians(0.5f * static_cast<float>(frame));
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, {1, 0, 0});
  camera.target = camera.eye + glm::vec3(turn * glm::vec4(camera.target - camera.eye, 0));
  return camera;
}

scene::Camera dollied(int frame) {
  scene::Camera camera = spheres_camera();
  camera.eye += (camera.target - camera.eye) * (0.012f * static_cast<float>(frame));
  return camera;
}

struct Movement {
  const char* name;
  scene::Camera (*camera)(int frame);
};

class MovingView : public testing::TestWithParam<Movement> {};

INSTANTIATE_TEST_SUITE_P(Directions, MovingView,
                         testing::Values(Movement{"yaw", yawed}, Movement{"pitch", pitched},
                                         Movement{"dolly", dollied}),
                         [](const auto& instance) { return std::string(instance.param.name); });

// A flipped axis in the motion vectors is invisible in a static view; one of the three reveals it.
TEST_P(MovingView, IsFarLessNoisyThanOneSample) {
  const int frames = 16;
  SpheresRig rig(denoised_only()), raw(noisy_only());
  render::Frame shown, noisy;
  for (int i = 0; i < frames; ++i) {
    rig.renderer.set_camera(GetParam().camera(i));
    shown = rig.renderer.render();
  }
  raw.renderer.set_camera(GetParam().camera(frames - 1));
  noisy = raw.renderer.render();
  const render::Frame reference = ground_truth_from(GetParam().camera(frames - 1));
  save_image(std::string("denoised_") + GetParam().name, shown);
  save_image(std::string("denoised_") + GetParam().name + "_ground_truth", reference);
  EXPECT_LT(difference(reference, shown).mean, 0.2 * difference(reference, noisy).mean);
  EXPECT_GT(ssim(reference, shown), 0.955);
  EXPECT_LT(ssim(reference, noisy), ssim(reference, shown) - 0.2);
}

}  // namespace
}  // namespace heliograph::test
