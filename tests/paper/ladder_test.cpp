// The paper's comparison of presets on two small scenes: the basis for the preset `best`.

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "tests/paper/report.hpp"
#include "tests/paper/stage.hpp"
#include "tests/support/engine.hpp"

namespace heliograph::paper {
namespace {

constexpr double tolerance = 0.005;
constexpr int samples = 64;

struct SceneCase {
  const char* scene;
  float value;
};

class Ladder : public testing::TestWithParam<std::tuple<SceneCase, Movement>> {
 protected:
  static std::map<std::string, Quality> measure(const SceneCase& scene_case, const Shot& shot) {
    const Swept swept = swept_in(scene_case.scene);
    const Stage stage(test::engine(), scene_case.scene, sweep_to(swept, scene_case.value),
                      {.width = 160, .height = 90, .texture_size = 32});
    const auto ground_truth = stage.ground_truth(GroundTruth::reference, shot, samples);
    std::map<std::string, Quality> result;
    std::vector<Measurement> rows;
    for (const Technique& technique : techniques()) {
      const Quality quality = compare(stage.play(technique.settings(), shot).frames, ground_truth);
      rows.push_back(
          {scene_case.scene, swept, scene_case.value, shot.movement, technique.name, quality});
      result[technique.name] = quality;
    }
    std::fputs(quality_tables(rows).c_str(), stdout);
    return result;
  }
};

using Tested = std::tuple<SceneCase, Movement>;

std::string name_of(const testing::TestParamInfo<Tested>& tested) {
  const SceneCase& scene_case = std::get<SceneCase>(tested.param);
  return std::string(scene_case.scene) + "_" + std::to_string(int(10.0f * scene_case.value)) + "_" +
         std::string(name(std::get<Movement>(tested.param)));
}

INSTANTIATE_TEST_SUITE_P(Paper, Ladder,
                         testing::Combine(testing::Values(SceneCase{"cubes_distance", 0.1f},
                                                          SceneCase{"cubes_distance", 0.4f},
                                                          SceneCase{"pillars", 2.0f},
                                                          SceneCase{"pillars", 10.0f}),
                                          testing::Values(Movement::still, Movement::moving_camera,
                                                          Movement::moving_objects_light)),
                         name_of);

TEST_P(Ladder, BestMatchesEveryPresetAndBeatsSvgfInMotion) {
  const auto& [scene_case, movement] = GetParam();
  const auto quality =
      measure(scene_case,
              {.movement = movement, .frames = 24, .compared = 2, .frame_seconds = 1.0f / 30.0f});
  const double best = quality.at("best").ssim;
  for (const char* preset : {"svgf", "rectification", "adapted", "separable", "reinhard"}) {
    EXPECT_GE(best, quality.at(preset).ssim - tolerance) << preset;
  }
  if (movement != Movement::still) {
    EXPECT_GT(best, quality.at("svgf").ssim);
  }
}

}  // namespace
}  // namespace heliograph::paper
