#include <gtest/gtest.h>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using Corners = std::array<glm::vec3, 4>;

/// A white room from -2 to 2, closed but for a small window in one wall, seen from inside.
std::shared_ptr<const scene::Scene> room_with_window() {
  SceneBuilder builder;
  constexpr float side = 2.0f, edge = 0.4f;  // half the width of the room, of the window
  const auto behind = [](float left, float right, float bottom, float top) {
    return Corners{
        {{left, bottom, -side}, {right, bottom, -side}, {right, top, -side}, {left, top, -side}}};
  };
  const std::array<Corners, 9> walls{{{{{-2, -2, 2}, {2, -2, 2}, {2, -2, -2}, {-2, -2, -2}}},
                                      {{{-2, 2, -2}, {2, 2, -2}, {2, 2, 2}, {-2, 2, 2}}},
                                      {{{2, -2, 2}, {-2, -2, 2}, {-2, 2, 2}, {2, 2, 2}}},
                                      {{{-2, -2, 2}, {-2, -2, -2}, {-2, 2, -2}, {-2, 2, 2}}},
                                      {{{2, -2, -2}, {2, -2, 2}, {2, 2, 2}, {2, 2, -2}}},
                                      behind(-side, -edge, -side, side),
                                      behind(edge, side, -side, side),
                                      behind(-edge, edge, -side, -edge),
                                      behind(-edge, edge, edge, side)}};
  builder.place(builder.add_quads(walls, surface(glm::vec3(0.5f))));
  return builder.build();
}

/// Sums over seeds.
struct Gathered {
  double mean = 0.0;
  double variance = 0.0;  // of one sample of a pixel, mean over pixels
};

/// Adds what single samples bring, after the guide has learnt.
void add_samples(Gathered& made, bool guided, std::uint32_t seed) {
  RendererRig rig(room_with_window(), scene::constant_environment(glm::vec3(4.0f)),
                  look({-1.5f, 1, -1.5f}, {0.5f, -0.5f, 1}, 75.0f), 64, 48);
  protocol::Settings settings;
  settings.accumulation.max_samples = 4096;
  settings.sampling.seed = seed;
  settings.indirect.path_guiding = guided;
  rig.apply(settings);
  rig.accumulate(96);
  constexpr int frames = 96;
  std::vector<double> sums(64 * 48), squares(64 * 48);
  for (int i = 0; i < frames; ++i) {
    rig.renderer.render();
    const render::FloatImage radiance = rig.capture("indirect.radiance");
    for (std::size_t p = 0; p < sums.size(); ++p) {
      const double value = radiance.rgba[4 * p];
      sums[p] += value / frames;
      squares[p] += value * value / frames;
    }
  }
  for (std::size_t p = 0; p < sums.size(); ++p) {
    made.mean += sums[p] / double(sums.size());
    made.variance += (squares[p] - sums[p] * sums[p]) / double(sums.size());
  }
}

TEST(PathGuiding, LowersTheVarianceOfLightThroughAWindow) {
  // The cells of the radiance cache are noise that all pixels share: the means of one seed differ
  // by 1.1 % (standard deviation of eight seeds).
  Gathered plain, guided;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    add_samples(plain, false, seed);
    add_samples(guided, true, seed);
  }
  RecordProperty("ratio", std::to_string(guided.mean / plain.mean));
  EXPECT_NEAR(guided.mean / plain.mean, 1.0, 0.02);
  EXPECT_LT(guided.variance, 0.6 * plain.variance);
}

}  // namespace
}  // namespace heliograph::test
