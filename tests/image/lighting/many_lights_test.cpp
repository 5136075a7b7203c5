#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t lights_width = 64, lights_height = 48;

/// A ground with spheres, for lights with a range of 2 m.
std::shared_ptr<scene::Scene> courtyard() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-20, 0, 20}, {20, 0, 20}, {20, 0, -20}, {-20, 0, -20}}},
                                 surface({0.8f, 0.7f, 0.6f}, 0.6f)));
  const auto sphere = builder.add_sphere(0.8f, surface(glm::vec3(0.9f), 0.25f, 1.0f));
  for (int i = 0; i < 9; ++i) {
    builder.place(
        sphere, glm::translate(glm::mat4(1.0f), glm::vec3(4 * (i % 3) - 4, 0.8f, 4 * (i / 3) - 4)));
  }
  return std::make_shared<scene::Scene>(*builder.build());
}

std::shared_ptr<const scene::Scene> courtyard_lit_by(const std::vector<scene::Light>& lights) {
  const auto scene = courtyard();
  scene->lights = lights;
  return scene;
}

std::vector<scene::Light> many_lights(int count) {
  std::mt19937 generator(17);
  std::uniform_real_distribution<float> position(-16.0f, 16.0f), color(0.1f, 1.0f);
  std::vector<scene::Light> all;
  for (int i = 0; i < count; ++i) {
    shared::Light light{};
    light.type = i % 3 ? shared::light_point : shared::light_disk;
    light.position = {position(generator), 1.0f, position(generator)};
    light.direction = {0, -1, 0};
    light.tangent = {1, 0, 0};
    light.color = glm::vec3(color(generator), color(generator), color(generator));
    light.range = 2.0f;
    light.radius = 0.1f;
    if (light.type == shared::light_disk) light.color *= 20.0f;
    all.push_back({"light", light});
  }
  return all;
}

/// Sums of all lights, without a grid.
render::FloatImage render_hdr(const std::shared_ptr<scene::Scene>& scene, const char* name) {
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)), look({0, 9, 12}, {0, 0, 0}),
                  lights_width, lights_height);
  protocol::Settings settings;
  settings.shadows.enabled = false;
  settings.antialiasing.jitter = false;
  settings.specular.enabled = false;
  settings.environment.visible = false;
  settings.lighting.light_grid = false;
  rig.apply(settings);
  const render::Frame frame = rig.accumulate(1);
  if (name) save_image(name, frame);
  return rig.capture("hdr");
}

/// Compares the light of `all` with the sum of that of parts, each of `at_once` lights.
void expect_sum_of_batches(const std::vector<scene::Light>& all, std::size_t at_once,
                           const char* name) {
  const auto scene = courtyard();
  scene->lights = all;
  const render::FloatImage together = render_hdr(scene, name);
  std::vector<double> sum(together.rgba.size(), 0.0);
  for (std::size_t first = 0; first < all.size(); first += at_once) {
    const std::size_t last = std::min(first + at_once, all.size());
    scene->lights.assign(all.begin() + first, all.begin() + last);
    const render::FloatImage part = render_hdr(std::make_shared<scene::Scene>(*scene), nullptr);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part.rgba[i];
  }
  double brightness = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (i % 4 == 3) continue;
    ASSERT_NEAR(together.rgba[i], sum[i], 1e-3 * sum[i] + 1e-4) << i / 4;
    brightness += sum[i] / (3 * lights_width * lights_height);
  }
  EXPECT_GT(brightness, 2.5e-5 * static_cast<double>(all.size()));
}

TEST(ManyLights, TwoThousandLightsEqualSumOfBatches) {
  constexpr std::size_t at_once = 190;  // all lights fit the uniform block
  static_assert(at_once < shared::uniform_lights);
  expect_sum_of_batches(many_lights(2000), at_once, "two_thousand_lights");
}

// Of so few lights none is left out where it does not reach.
TEST(ManyLights, LightsOutOfReachAreLeftOutWithoutADifference) {
  expect_sum_of_batches(many_lights(120), 12, "lights_out_of_reach");
}

/// Point and spot lights without range in the same places.
std::vector<scene::Light> unlimited_lights(int count) {
  std::vector<scene::Light> all = many_lights(count);
  for (std::size_t i = 0; i < all.size(); ++i) {
    shared::Light& light = all[i].device;
    if (light.type == shared::light_disk) light.color *= 0.05f;
    light.type = i % 5 == 0 ? shared::light_spot : shared::light_point;
    light.range = 0.0f;
    light.color *= 600.0f / static_cast<float>(count);
    light.spot_scale = 3.0f;
    light.spot_offset = -1.5f;
  }
  return all;
}

/// The mean of `samples` frames.
render::FloatImage render_lit_mean(const std::vector<scene::Light>& lights, bool by_grid,
                                   std::uint32_t samples, bool shadows) {
  RendererRig rig(courtyard_lit_by(lights), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 9, 12}, {0, 0, 0}), lights_width, lights_height);
  protocol::Settings settings = undenoised();
  settings.shadows.enabled = shadows;
  settings.specular.enabled = shadows;
  settings.specular.hit_shading = protocol::HitShading::traced;
  settings.antialiasing.jitter = false;
  settings.environment.visible = false;
  settings.lighting.light_grid = by_grid;
  rig.apply(settings);
  const render::Frame frame = rig.accumulate(samples);
  save_image(by_grid ? "lights_by_grid" : "lights_summed", frame);
  return rig.capture("accumulated");
}

struct Deviation {
  double mean;  // of the images' sums
  double rms;   // of pixels; both relative to the exact image's mean
};
Deviation deviation(const render::FloatImage& exact, const render::FloatImage& other) {
  double sum = 0.0, off = 0.0, squares = 0.0, pixels = 0.0;
  for (std::size_t i = 0; i < exact.rgba.size(); i += 4) {
    const double expected = exact.rgba[i] + exact.rgba[i + 1] + exact.rgba[i + 2];
    const double error = other.rgba[i] + other.rgba[i + 1] + other.rgba[i + 2] - expected;
    sum += expected;
    off += error;
    squares += error * error;
    pixels += 1.0;
  }
  return {off / sum, std::sqrt(squares / pixels) / (sum / pixels)};
}

TEST(ManyLights, OneFrameByTheGridIsNotFarFromTheSum) {
  const auto lights = unlimited_lights(1000);
  const auto exact = render_lit_mean(lights, false, 1, false);
  const Deviation one = deviation(exact, render_lit_mean(lights, true, 1, false));
  RecordProperty("relative_error", std::to_string(one.rms));
  EXPECT_LT(one.rms, 1.0);  // nearly all of it in highlights of metal
  EXPECT_LT(std::abs(one.mean), 0.05);
}

TEST(ManyLights, FramesByTheGridConvergeToTheSum) {
  const auto lights = unlimited_lights(1000);
  const auto exact = render_lit_mean(lights, false, 1, false);
  const Deviation many = deviation(exact, render_lit_mean(lights, true, 256, false));
  EXPECT_LT(many.rms, 0.04);
  EXPECT_LT(std::abs(many.mean), 1e-3);
}

TEST(ManyLights, ShadowsAndReflectionsByTheGridConvergeToThoseOfAllLights) {
  const auto lights = unlimited_lights(300);
  const auto exact = render_lit_mean(lights, false, 512, true);
  const Deviation many = deviation(exact, render_lit_mean(lights, true, 512, true));
  EXPECT_LT(std::abs(many.mean), 4e-3);
  EXPECT_LT(many.rms, 0.1);
}

scene::Camera passing(int frame) {
  return look({0.05f * static_cast<float>(frame), 6, 12}, {0, 0, 0});
}
constexpr int last_frame = 40;

render::Frame render_passing(const std::vector<scene::Light>& lights, bool by_grid) {
  RendererRig rig(courtyard_lit_by(lights), scene::constant_environment(glm::vec3(0.1f)),
                  passing(0), 320, 180);
  protocol::Settings settings;
  settings.indirect.enabled = false;
  settings.lighting.light_grid = by_grid;
  rig.apply(settings);
  rig.renderer.set_frame_seconds(1.0f / 30.0f);
  render::Frame shown;
  for (int i = 0; i <= last_frame; ++i) {
    rig.renderer.set_camera(passing(i));
    shown = rig.renderer.render();
  }
  save_image(by_grid ? "passing_by_grid" : "passing_summed", shown);
  return shown;
}

/// The mean of many frames at rest, by the sum of all lights.
render::Frame render_passing_truth(const std::vector<scene::Light>& lights) {
  RendererRig rig(courtyard_lit_by(lights), scene::constant_environment(glm::vec3(0.1f)),
                  passing(last_frame), 320, 180);
  protocol::Settings settings = undenoised();
  settings.lighting.light_grid = false;
  rig.apply(settings);
  const render::Frame truth = rig.accumulate(48);
  save_image("passing_truth", truth);
  return truth;
}

TEST(ManyLights, AMovingViewByTheGridIsNearlyAsSimilarToTheGroundTruth) {
  const auto lights = unlimited_lights(1000);
  const render::Frame truth = render_passing_truth(lights);
  const double summed = ssim(truth, render_passing(lights, false));
  const double by_grid = ssim(truth, render_passing(lights, true));
  RecordProperty("summed", std::to_string(summed));
  RecordProperty("by_grid", std::to_string(by_grid));
  EXPECT_GT(by_grid, summed - 0.06);
}

/// Processor time of a frame, seconds.
double frame_cost(RendererRig& rig, int frame) {
  rig.renderer.set_camera(look({0.02f * static_cast<float>(frame), 9, 12}, {0, 0, 0}));
  const std::clock_t before = std::clock();
  rig.renderer.render();
  return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
}

TEST(ManyLights, CostHardlyGrowsWithTheirNumber) {
  const auto lit_by = [](int lights) {
    return RendererRig(courtyard_lit_by(unlimited_lights(lights)),
                       scene::constant_environment(glm::vec3(0.2f)), look({0, 9, 12}, {0, 0, 0}),
                       320, 180);
  };
  RendererRig few = lit_by(17), many = lit_by(1000);
  // By turns: what else the machine does meanwhile disturbs both alike.
  std::vector<double> ratios;
  for (int frame = 0; frame < 60; ++frame) {
    const double of_few = frame_cost(few, frame), of_many = frame_cost(many, frame);
    if (frame >= 28) ratios.push_back(of_many / of_few);
  }
  const auto median = ratios.begin() + 16;
  std::nth_element(ratios.begin(), median, ratios.end());
  RecordProperty("ratio", std::to_string(*median));
  EXPECT_LT(*median, 1.5);
}

}  // namespace
}  // namespace heliograph::test
