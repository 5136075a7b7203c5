#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t view_width = 160, view_height = 90;

/// Surfaces of several roughnesses with soft shadows, and thin bars, behind whose edges the
/// denoiser has no history.
std::shared_ptr<const scene::Scene> bars_and_spheres() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface({0.6f, 0.55f, 0.5f}, 0.15f)));
  builder.place(builder.add_sphere(0.8f, surface({0.8f, 0.2f, 0.1f}, 0.4f)),
                glm::translate(glm::mat4(1.0f), {-0.9f, 0.8f, 0}));
  builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.8f, 0.6f}, 0.2f, 1.0f)),
                glm::translate(glm::mat4(1.0f), {0.8f, 0.6f, 0.5f}));
  const auto bar =
      builder.add_quad({{{-0.03f, 0, 0}, {0.03f, 0, 0}, {0.03f, 2, 0}, {-0.03f, 2, 0}}},
                       surface({0.2f, 0.3f, 0.7f}));
  for (int i = 0; i < 12; ++i) {
    builder.place(bar, glm::translate(glm::mat4(1.0f), {-2.2f + 0.4f * float(i), 0, -1.5f}));
  }
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 8.0f);
  builder.add_point_light({1.5f, 2, 1}, {2, 1, 0.5f}, 0.2f);
  return builder.build();
}

RendererRig make_view() {
  return RendererRig(bars_and_spheres(), scene::constant_environment(glm::vec3(0.5f, 0.6f, 0.8f)),
                     look({0.5f, 2, 4.5f}, {0, 0.5f, 0}), view_width, view_height);
}

render::Frame true_view() {
  RendererRig rig = make_view();
  protocol::Settings settings = undenoised();
  settings.sampling.seed = 99;
  rig.apply(settings);
  return rig.accumulate(1024);
}

/// Comes to rest where make_view() looks.
void move(RendererRig& rig) {
  for (int i = 11; i >= 0; --i) {
    rig.renderer.set_camera(look({0.5f + 0.08f * static_cast<float>(i), 2, 4.5f}, {0, 0.5f, 0}));
    rig.renderer.render();
  }
}

TEST(StaticView, NeverGetsWorse) {
  const render::Frame truth = true_view();
  RendererRig rig = make_view();
  move(rig);
  double best = 0.0, first = 0.0;
  std::string all;
  for (std::uint32_t samples = 2; samples <= 64; ++samples) {
    const double similarity = ssim(truth, rig.accumulate(samples));
    all += std::to_string(similarity) + " ";
    // One frame's pattern of jitter may be a little less lucky than another's.
    EXPECT_GT(similarity, best - 0.002) << samples;
    if (samples == 2) first = similarity;
    best = std::max(best, similarity);
  }
  RecordProperty("similarity", all);
  EXPECT_LT(1.0 - best, 0.5 * (1.0 - first));
}

TEST(StaticView, NoiseDecidesBetterThanTheNumberOfSamples) {
  const render::Frame truth = true_view();
  for (const std::uint32_t samples : {4u, 16u, 64u}) {
    const auto similarity = [&](bool by_noise) {
      RendererRig rig = make_view();
      protocol::Settings settings;
      settings.accumulation.by_noise = by_noise;
      rig.apply(settings);
      move(rig);
      return ssim(truth, rig.accumulate(samples));
    };
    EXPECT_GT(similarity(true), similarity(false)) << samples;
  }
}

// Frames that were drawn smaller leave histories of fewer and larger pixels behind.
// What frames of a quarter of the pixels leave behind counts as a quarter of the samples.
TEST(StaticView, CountsReducedFramesByTheirPixels) {
  const auto history_length_after_motion_at = [](float scale) {
    RendererRig rig = make_view();
    protocol::Settings settings;
    settings.sampling.visibility = false;  // every frame counts
    rig.apply(settings);
    rig.renderer.set_draw_scale(scale);
    for (int i = 0; i < 48; ++i) {
      rig.renderer.set_camera(look({0.5f + 0.01f * float(i % 2), 2, 4.5f}, {0, 0.5f, 0}));
      rig.renderer.render();
    }
    rig.renderer.set_draw_scale(1.0f);
    rig.accumulate(3);
    const render::FloatImage length = rig.capture("visibility.history_length");
    double sum = 0.0;
    for (std::size_t i = 0; i < length.rgba.size(); i += 4) sum += length.rgba[i];
    return sum / static_cast<double>(length.rgba.size() / 4);
  };
  const double reduced = history_length_after_motion_at(0.5f);
  const double full = history_length_after_motion_at(1.0f);
  EXPECT_LT(reduced, 0.5 * full) << full;
  EXPECT_GT(reduced, 0.2 * full) << full;
}

TEST(StaticView, ForgetsReducedFramesSoon) {
  const render::Frame truth = true_view();
  const auto similarity_after_motion_at = [&](float scale) {
    RendererRig rig = make_view();
    rig.renderer.set_draw_scale(scale);
    move(rig);
    rig.renderer.set_draw_scale(1.0f);
    return ssim(truth, rig.accumulate(8));
  };
  const double reduced = similarity_after_motion_at(0.5f), full = similarity_after_motion_at(1.0f);
  RecordProperty("similarity", std::to_string(reduced) + " " + std::to_string(full));
  EXPECT_GT(reduced, full - 0.004);
}

TEST(StaticView, ConvergesToTheMean) {
  RendererRig rig = make_view();
  protocol::Settings settings;
  settings.accumulation.max_samples = 4096;
  rig.apply(settings);
  move(rig);
  const auto distance_from_mean = [&] {
    return difference(rig.capture("output.radiance"), rig.capture("accumulated")).mean;
  };
  rig.accumulate(16);
  const double early = distance_from_mean();
  rig.accumulate(1024);
  EXPECT_LT(distance_from_mean(), 0.2 * early);
}

TEST(StaticView, MovingFramesShowNoneOfTheMean) {
  RendererRig rig = make_view();
  move(rig);
  const render::FloatImage weights = rig.capture("mean_weight");
  for (std::size_t i = 0; i < weights.rgba.size(); i += 4) ASSERT_EQ(weights.rgba[i], 0.0f);
}

TEST(StaticView, CapturesShowTheWeightThatAllPixelsHave) {
  RendererRig rig = make_view();
  protocol::Settings settings;
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 8;
  rig.apply(settings);
  const auto expect_weight = [&](float expected) {
    const render::FloatImage weights = rig.capture("mean_weight");
    for (std::size_t i = 0; i < weights.rgba.size(); i += 4) ASSERT_EQ(weights.rgba[i], expected);
    for (const render::BufferValue& value : rig.renderer.inspect({0.5f, 0.5f})) {
      if (value.name != "mean_weight") continue;
      EXPECT_EQ(value.channels, std::vector{expected});
    }
  };
  rig.accumulate(9);
  expect_weight(0.5f);
  const render::FloatImage half = rig.capture("output.radiance");
  // Of the frame that was finished, whatever comes next.
  rig.renderer.set_camera(look({0.6f, 2, 4.5f}, {0, 0.5f, 0}));
  expect_weight(0.5f);
  EXPECT_EQ(rig.capture("output.radiance").rgba, half.rgba);
  rig.renderer.render();
  expect_weight(0.0f);
  EXPECT_NE(rig.capture("output.radiance").rgba, half.rgba);
  settings.accumulation.blend_samples = 0;  // the mean alone
  rig.apply(settings);
  rig.renderer.render();
  expect_weight(1.0f);
}

}  // namespace
}  // namespace heliograph::test
