// The converged hybrid without denoisers against the path tracer along the same light paths: the
// eight scenes of the paper, with uniform roughness and one angular diameter of the sun.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "scenes/generator/scenes/paper_scenes.hpp"
#include "tests/convergence/mean_luminance.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/generated_scene.hpp"

namespace heliograph::test {
namespace {

constexpr double tolerance = 0.01;
constexpr double max_standard_error = 0.003;  // of a relative difference
constexpr int least_blocks = 4;
constexpr int most_blocks = 256;
constexpr std::uint32_t samples = 16;  // per pixel and block

constexpr float roughnesses[] = {0.0f, 0.1f, 0.2f, 0.3f, 0.4f, 0.6f, 1.0f};
constexpr float angles[] = {0.0f, 2.0f, 6.0f, 10.0f};  // degrees

/// The hybrid without denoising and without indirect light. The background is equal in both images
/// and is hidden, because it would dilute differences.
protocol::Settings undenoised(float angle) {
  protocol::Settings settings;
  settings.indirect.enabled = false;
  settings.shadow_temporal.enabled = settings.shadow_blur.enabled = false;
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  settings.antialiasing.temporal = false;
  settings.environment.visible = false;
  settings.shadows.angular_diameter_override = angle;
  return settings;
}

protocol::Settings path_traced(float angle) {
  protocol::Settings settings = undenoised(angle);
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::same_paths;
  return settings;
}

/// A scene of the paper with uniform roughness.
class ConvergenceRig {
 public:
  ConvergenceRig(const std::string& name, float roughness) : renderer_(engine()) {
    const scenes::PaperScene& recipe = scenes::find_paper_scene(name);
    const scenes::ClearSky sky = recipe.make_sky(256, 128);
    scenes::Document document = recipe.make_document(sky);
    for (scenes::Material& material : document.materials) material.uniform_roughness = roughness;
    const auto scene =
        std::make_shared<const scene::Scene>(import_generated(document, texture_size));
    renderer_.set_scene(engine().upload(scene, import_generated(sky.environment)));
    renderer_.set_size(128, 72);
    renderer_.set_camera(scene->cameras.at(0));
  }

  /// Renders blocks until the standard error is small enough: sharp highlights are rare and bright.
  RelativeDifference difference(float angle) {
    std::vector<double> got, expected;
    RelativeDifference found;
    for (int blocks = least_blocks; blocks <= most_blocks; blocks *= 2) {
      const int first = static_cast<int>(got.size());
      append(got, mean_luminances(renderer_, undenoised(angle), first, blocks, samples));
      append(expected, mean_luminances(renderer_, path_traced(angle), first, blocks, samples));
      found = relative_difference(got, expected);
      if (found.standard_error < max_standard_error) break;
    }
    return found;
  }

 private:
  static constexpr int texture_size = 32;

  static void append(std::vector<double>& all, const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
  }

  render::Renderer renderer_;
};

void expect_converged(const std::string& scene, float roughness, float angle, ConvergenceRig& rig) {
  const RelativeDifference found = rig.difference(angle);
  std::printf("%-16s roughness %.1f, angle %4.1f: %+.2f %% (+- %.2f)\n", scene.c_str(),
              static_cast<double>(roughness), static_cast<double>(angle), 100.0 * found.value,
              100.0 * found.standard_error);
  EXPECT_LT(std::abs(found.value), tolerance) << "roughness " << roughness << ", angle " << angle;
  EXPECT_LT(found.standard_error, max_standard_error)
      << "roughness " << roughness << ", angle " << angle;
}

class Grid : public testing::TestWithParam<std::tuple<std::string, float>> {};

TEST_P(Grid, HybridConvergesToReference) {
  const auto& [scene, roughness] = GetParam();
  ConvergenceRig rig(scene, roughness);
  for (const float angle : angles) expect_converged(scene, roughness, angle, rig);
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const scenes::PaperScene& scene : scenes::paper_scenes()) names.emplace_back(scene.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Paper, Grid,
                         testing::Combine(testing::ValuesIn(scene_names()),
                                          testing::ValuesIn(roughnesses)),
                         [](const auto& tested) {
                           const float roughness = std::get<float>(tested.param);
                           return std::get<std::string>(tested.param) + "_" +
                                  std::to_string(std::lround(10.0f * roughness));
                         });

struct Cell {
  const char* scene;
  float roughness;
  float angle;
};

/// A subset with every scene, roughness and angle at least once, for the default test run.
class Cover : public testing::TestWithParam<Cell> {};

TEST_P(Cover, HybridConvergesToReference) {
  const auto [scene, roughness, angle] = GetParam();
  ConvergenceRig rig(scene, roughness);
  expect_converged(scene, roughness, angle, rig);
}

INSTANTIATE_TEST_SUITE_P(
    Paper, Cover,
    testing::Values(Cell{"cubes_distance", 0.0f, 0.0f}, Cell{"icosphere", 0.4f, 2.0f},
                    Cell{"glossy_sponza_1", 0.2f, 6.0f}, Cell{"glossy_sponza_2", 0.3f, 10.0f},
                    Cell{"glossy_sponza_3", 1.0f, 0.0f}, Cell{"shadow_objects", 0.1f, 2.0f},
                    Cell{"pillars", 0.6f, 6.0f}, Cell{"breakfast_room", 0.0f, 10.0f}),
    [](const auto& tested) { return std::string(tested.param.scene); });

TEST(RelativeDifference, HasStandardError) {
  const double got[] = {1.01, 1.03, 1.02, 1.02};
  const double expected[] = {1.0, 1.0, 1.0, 1.0};
  const RelativeDifference found = relative_difference(got, expected);
  EXPECT_NEAR(found.value, 0.02, 1e-12);
  EXPECT_NEAR(found.standard_error, std::sqrt(2e-4 / 12.0), 1e-9);
  EXPECT_THROW(relative_difference({got, 1}, {expected, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace heliograph::test
