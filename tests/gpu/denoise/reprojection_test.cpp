// Where the points of a frame were in the frame before.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "render/passes/denoise/temporal.hpp"
#include "tests/gpu/denoise/post_and_wall.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = wall_extent.width, height = wall_extent.height;
constexpr std::uint32_t pixels = width * height;

/// Renders two frames from two camera positions and reprojects the second into the first.
render::FloatImage reprojected(PostAndWall& scene, float before, float now,
                               protocol::Settings settings = {}) {
  settings.antialiasing.jitter = false;
  FrameRig rig(scene.builder.build(), scene.from(before),
               {.extent = wall_extent, .settings = settings});
  const render::GBuffer gbuffer = render::rasterize_gbuffer(rig.plan(), rig.inputs());
  const render::Guide guide = render::reproject(rig.plan(), rig.inputs(), gbuffer);
  rig.run();
  rig.set_view(scene.from(now));
  rig.run();
  return rig.read(guide.reprojection);
}

TEST(Reprojection, StaticViewMapsPixelToItself) {
  PostAndWall scene(1.0f);
  const render::FloatImage found = reprojected(scene, 0.3f, 0.3f);
  for (std::uint32_t i = 0; i < pixels; ++i) {
    EXPECT_EQ(found.rgba[4 * i], static_cast<float>(i % width) + 0.5f);
    EXPECT_EQ(found.rgba[4 * i + 1], static_cast<float>(i / width) + 0.5f);
    EXPECT_EQ(found.rgba[4 * i + 2], 1.0f) << "one tap";
    EXPECT_EQ(found.rgba[4 * i + 3], 0.0f);
  }
}

/// Expects disocclusion exactly where the post hid the wall or the texel was outside the frame.
void expect_exact_history(bool joined) {
  PostAndWall scene(1.0f, joined);
  const float before = 0.0f, now = 1.2f;
  const render::FloatImage found = reprojected(scene, before, now);
  const double focal = 0.5 * height / std::tan(glm::radians(22.5));  // pixels
  int hidden = 0;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double slope = (x + 0.5 - 0.5 * width) / focal;
      const bool post = std::abs(now + 4.0 * slope) < 0.4;
      const double position = post ? now + 4.0 * slope : now + 8.0 * slope;  // on post or wall
      const double depth = post ? 4.0 : 8.0;
      const double column = (position - before) / depth * focal + 0.5 * width;
      // From the previous camera the post hides the wall where the view ray crosses the post.
      const double at_post = before + (position - before) * 0.5;
      const double from_edge = std::abs(std::abs(at_post) - 0.4) / 4.0 * focal;
      const bool covered = !post && std::abs(at_post) < 0.4;
      const double from_border = std::min(std::abs(column), std::abs(column - width));
      if ((!post && from_edge < 1.6) || from_border < 1.6) continue;  // 3x3 search
      const bool outside = column < 0.0 || column > width;
      const bool lost = found.rgba[4 * (y * width + x) + 3] == 1.0f;
      EXPECT_EQ(lost, covered || outside) << x << " " << y;
      hidden += covered;
      if (!lost) {
        EXPECT_NEAR(found.rgba[4 * (y * width + x)], column, 0.02) << x;
      }
    }
  }
  EXPECT_GT(hidden, 20) << "too few disoccluded pixels for a test";
}

/// A published denoiser reconstructs the previous position with the current matrix and fails this.
TEST(Reprojection, DisocclusionMatchesAnalyticVisibility) {
  for (const bool joined : {false, true}) {
    SCOPED_TRACE(joined ? "one instance" : "two instances");
    expect_exact_history(joined);
  }
}

/// Whether a pixel's center shows the post; nullopt where it is too close to the edge to decide.
std::optional<bool> shows_post(double x, double eye) {
  const double focal = 0.5 * height / std::tan(glm::radians(22.5));  // pixels
  const double position = eye + 4.0 * (x - 0.5 * width) / focal;
  if (std::abs(std::abs(position) - 0.4) / 4.0 * focal < 0.02) return std::nullopt;
  return std::abs(position) < 0.4;
}

/// Expects that of the four bilinear taps only those on the same surface are used.
void expect_own_taps(bool joined) {
  PostAndWall scene(1.0f, joined);
  const float before = 0.0f, now = 0.17f;
  const render::FloatImage found = reprojected(scene, before, now);
  int shared = 0;
  for (std::uint32_t i = 0; i < pixels; ++i) {
    const float* texel = &found.rgba[4 * i];
    const std::optional<bool> own = shows_post(i % width + 0.5, now);
    if (texel[3] != 0.0f || !own) continue;
    const auto mask = static_cast<unsigned>(texel[2]);
    const double left = std::floor(texel[0] - 0.5);
    const std::optional<bool> sides[2] = {shows_post(left + 0.5, before),
                                          shows_post(left + 1.5, before)};
    for (unsigned tap = 0; tap < 4; ++tap) {
      const std::optional<bool> tap_shows_post = sides[tap & 1];
      if (!(mask >> tap & 1) || !tap_shows_post) continue;
      EXPECT_EQ(*tap_shows_post, *own) << i % width << ", tap " << tap;
    }
    shared += sides[0] && sides[1] && *sides[0] != *sides[1];
  }
  EXPECT_GT(shared, 20) << "too few edge pixels for a test";
}

TEST(Reprojection, RejectsTapsOfOtherSurfaces) {
  for (const bool joined : {false, true}) {
    SCOPED_TRACE(joined ? "one instance" : "two instances");
    expect_own_taps(joined);
  }
}

TEST(Reprojection, IsScaleInvariant) {
  for (const bool joined : {false, true}) {
    PostAndWall one(1.0f, joined), small(0.01f, joined), large(100.0f, joined);
    const render::FloatImage expected = reprojected(one, 0.0f, 0.25f);
    for (PostAndWall* scene : {&small, &large}) {
      const render::FloatImage found = reprojected(*scene, 0.0f, 0.25f);
      int different = 0;
      for (std::uint32_t i = 0; i < pixels; ++i) {
        different += found.rgba[4 * i + 3] != expected.rgba[4 * i + 3];
      }
      EXPECT_LE(different, 2) << scene->scale << (joined ? ", one instance" : ", two instances");
    }
  }
}

}  // namespace
}  // namespace heliograph::test
