#include <gtest/gtest.h>

#include "tests/paper/stage.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/similarity.hpp"

namespace heliograph::paper {
namespace {

// What a viewer sees after a motion ends, sample by sample, in scenes of many small reflections, of
// rare bright ones and of soft shadows.
TEST(StaticView, NeverGetsWorseInThePapersScenes) {
  for (const char* const scene : {"glossy_sponza_1", "breakfast_room", "pillars"}) {
    const Swept swept = swept_in(scene);
    const Stage stage(test::engine(), scene, sweep_to(swept, paper_values(swept)[1]),
                      {.width = 192, .height = 108});
    const Shot shot{.movement = Movement::moving_camera, .frames = 20, .compared = 1};
    protocol::Settings settings;
    settings.indirect.enabled = false;
    const render::Frame truth = stage.ground_truth(GroundTruth::accumulated, shot, 384).front();
    double best = 0.0;
    std::string all;
    for (const render::Frame& frame : stage.rest(settings, shot, 48)) {
      const double similarity = test::ssim(truth, frame);
      all += std::to_string(similarity) + " ";
      // One frame's pattern of jitter may be a little less lucky than another's.
      EXPECT_GT(similarity, best - 0.008) << scene << " after " << frame.samples;
      best = std::max(best, similarity);
    }
    RecordProperty(scene, all);
    EXPECT_GT(best, 0.94) << scene;
  }
}

}  // namespace
}  // namespace heliograph::paper
