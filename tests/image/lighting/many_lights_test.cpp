#include <gtest/gtest.h>

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

render::FloatImage render_hdr(const std::shared_ptr<scene::Scene>& scene, const char* name) {
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)), look({0, 9, 12}, {0, 0, 0}),
                  lights_width, lights_height);
  protocol::Settings settings;
  settings.shadows.enabled = false;
  settings.antialiasing.jitter = false;
  settings.specular.enabled = false;
  settings.environment.visible = false;
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

}  // namespace
}  // namespace heliograph::test
