// The paper's ladder on two small scenes: the basis for calling a preset `best`.

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

struct Place {
  const char* scene;
  float value;
};

class Ladder : public testing::TestWithParam<std::tuple<Place, Movement>> {
 protected:
  static std::map<std::string, Quality> climb(const Place& place, const Shot& shot) {
    const Swept swept = swept_in(place.scene);
    const Stage stage(test::engine(), place.scene, sweep_to(swept, place.value),
                      {.width = 160, .height = 90, .texture_size = 32});
    const auto truth = stage.truth(Truth::reference, shot, samples);
    std::map<std::string, Quality> result;
    std::vector<Measurement> rows;
    for (const Technique& technique : techniques()) {
      const Quality quality = compare(stage.play(technique.settings(), shot), truth);
      rows.push_back({place.scene, swept, place.value, shot.movement, technique.name, quality});
      result[technique.name] = quality;
    }
    std::fputs(quality_tables(rows).c_str(), stdout);
    return result;
  }
};

using Tested = std::tuple<Place, Movement>;

std::string name_of(const testing::TestParamInfo<Tested>& tested) {
  const Place& place = std::get<Place>(tested.param);
  return std::string(place.scene) + "_" + std::to_string(int(10.0f * place.value)) + "_" +
         std::string(name(std::get<Movement>(tested.param)));
}

INSTANTIATE_TEST_SUITE_P(
    Paper, Ladder,
    testing::Combine(testing::Values(Place{"cubes_distance", 0.1f}, Place{"cubes_distance", 0.4f},
                                     Place{"pillars", 2.0f}, Place{"pillars", 10.0f}),
                     testing::Values(Movement::still, Movement::moving_camera,
                                     Movement::moving_objects_light)),
    name_of);

TEST_P(Ladder, BestMatchesEveryPresetAndBeatsSvgfInMotion) {
  const auto& [place, movement] = GetParam();
  const auto quality = climb(
      place, {.movement = movement, .frames = 24, .compared = 2, .frame_seconds = 1.0f / 30.0f});
  const double best = quality.at("best").ssim;
  for (const char* rung : {"svgf", "rectification", "adapted", "separable", "reinhard"}) {
    EXPECT_GE(best, quality.at(rung).ssim - tolerance) << rung;
  }
  if (movement != Movement::still) {
    EXPECT_GT(best, quality.at("svgf").ssim);
  }
}

}  // namespace
}  // namespace heliograph::paper
