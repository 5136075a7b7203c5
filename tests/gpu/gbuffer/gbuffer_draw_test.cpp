#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "render/passes/gbuffer/draw_gbuffer.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "scene/import.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/gpu/support/textured_scene.hpp"
#include "tests/support/scene_files.hpp"

namespace heliograph::test {
namespace {

scene::Camera view_of(const scene::Scene& scene, bool orthographic) {
  scene::Camera camera = scene::fit_camera(scene.bounds, 40.0f, 1.5f);
  if (orthographic) camera.orthographic_height = 2.2f * scene.bounds.radius();
  return camera;
}

/// The G-buffer by the host's rasteriser and by rays.
class DrawComparison {
 public:
  DrawComparison(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera,
                 VkExtent2D extent)
      : rig_(std::move(scene), camera, {.extent = extent, .tracer = "embree"}),
        camera_(camera),
        traced_(render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, true))),
        drawn_(render::draw_gbuffer(rig_.plan(), with_host_kernels(rig_, true))) {
    scene::Camera moved = camera;
    moved.eye += glm::vec3(0.05f, -0.02f, 0.03f);
    rig_.set_view(moved, 3);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }

  void expect_equal(const std::string& which) const {
    expect_same_gbuffer(rig_, traced_, drawn_, which);
  }

  /// Pixels in which only one of the two found a surface.
  int disagreements() const {
    const render::FloatImage rays = rig_.read(traced_.instance), drawn = rig_.read(drawn_.instance);
    int count = 0;
    for (std::size_t i = 0; i < rays.rgba.size(); i += 4) {
      count += (rays.rgba[i] == 0.0f) != (drawn.rgba[i] == 0.0f);
    }
    return count;
  }

 private:
  FrameRig rig_;
  scene::Camera camera_;
  render::GBuffer traced_, drawn_;
};

class GBufferDraw : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(GBufferDraw, MatchesRays) {
  for (const bool orthographic : {false, true}) {
    const std::string view = orthographic ? "orthographic" : "perspective";
    for (const auto& [name, scene] :
         {std::pair("textured", textured_scene()), std::pair("transparent", transparent_scene())}) {
      DrawComparison(scene, view_of(*scene, orthographic), {150, 100})
          .expect_equal(name + (", " + view));
    }
  }
}

TEST_F(GBufferDraw, MatchesRaysForDamagedHelmet) {
  const auto file = asset("gltf/DamagedHelmet.glb");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(*file));
  DrawComparison(scene, view_of(*scene, false), {300, 200}).expect_equal("helmet");
}

TEST_F(GBufferDraw, MatchesRaysAtAnySize) {
  const auto scene = textured_scene();
  for (const VkExtent2D extent :
       {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {32, 32}, {33, 65}, {130, 1}}) {
    DrawComparison(scene, view_of(*scene, false), extent)
        .expect_equal(std::to_string(extent.width) + " x " + std::to_string(extent.height));
  }
}

using Corners = std::array<glm::vec3, 4>;

/// A box around the origin, seen from inside.
std::shared_ptr<const scene::Scene> room(float half) {
  std::vector<Corners> walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-half, half}) {
      glm::vec3 middle(0.0f), u(0.0f), v(0.0f);
      middle[axis] = side;
      u[(axis + 1) % 3] = half;
      v[(axis + 2) % 3] = side > 0.0f ? -half : half;
      walls.push_back({middle - u - v, middle + u - v, middle + u + v, middle - u + v});
    }
  }
  SceneBuilder builder;
  builder.place(builder.add_quads(walls, surface({0.5f, 0.6f, 0.7f})));
  return builder.build();
}

// Walls reach behind the eye, far beyond the frame and through the near plane.
TEST_F(GBufferDraw, MatchesRaysInsideARoom) {
  for (const float half : {1.0f, 400.0f}) {
    for (const glm::vec3& target : {glm::vec3(1, 0, 0), glm::vec3(0.3f, -1, 0.2f),
                                    glm::vec3(-1, -1, -1), glm::vec3(0.2f, 0.1f, 1)}) {
      scene::Camera camera = look(half * glm::vec3(0.4f, -0.7f, 0.3f), half * target, 80.0f);
      DrawComparison comparison(room(half), camera, {150, 100});
      comparison.expect_equal("room of " + std::to_string(half));
      EXPECT_EQ(comparison.disagreements(), 0);
    }
  }
}

TEST_F(GBufferDraw, ClipsAtTheNearPlane) {
  SceneBuilder builder;
  const std::vector<Corners> floor{{{{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}}};
  builder.place(builder.add_quads(floor, surface({0.5f, 0.6f, 0.7f})));
  scene::Camera camera = look({0, 0.5f, 3}, {0, 0, 0}, 60.0f);
  camera.near_plane = 1.5f;
  DrawComparison comparison(builder.build(), camera, {150, 100});
  comparison.expect_equal("floor");
  EXPECT_LE(comparison.disagreements(), 4);
}

/// A sheet of waves, of so many quads each way.
std::shared_ptr<const scene::Scene> waves(int quads, float size) {
  const auto point = [&](int column, int row) {
    const float x = size * (static_cast<float>(column) / static_cast<float>(quads) - 0.5f);
    const float y = size * (static_cast<float>(row) / static_cast<float>(quads) - 0.5f);
    return glm::vec3(x, y, 0.3f * std::sin(3.1f * x) * std::cos(2.3f * y));
  };
  std::vector<Corners> all;
  for (int row = 0; row < quads; ++row) {
    for (int column = 0; column < quads; ++column) {
      all.push_back({point(column, row), point(column + 1, row), point(column + 1, row + 1),
                     point(column, row + 1)});
    }
  }
  SceneBuilder builder;
  builder.place(builder.add_quads(all, surface({0.5f, 0.6f, 0.7f})));
  return builder.build();
}

// Quads smaller than a pixel, and a few that reach beyond the frame.
TEST_F(GBufferDraw, LeavesNoGapBetweenTriangles) {
  for (const int quads : {3, 40, 250}) {
    const auto scene = waves(quads, 12.0f);
    for (const float turn : {0.0f, 0.37f, -1.1f}) {
      DrawComparison comparison(scene, look({turn, 0.4f * turn, 2.5f}, {0, 0, 0}), {150, 100});
      EXPECT_EQ(comparison.disagreements(), 0) << quads << " quads, turned by " << turn;
      comparison.expect_equal(std::to_string(quads) + " quads");
    }
  }
}

TEST_F(GBufferDraw, IsFasterThanRays) {
  const auto scene = waves(200, 4.0f);
  DrawComparison comparison(scene, look({0, 0, 2.5f}, {0, 0, 0}), {640, 360});
  comparison.rig().run();
  float drawn = 1e9f, traced = 1e9f;
  for (int i = 0; i < 8; ++i) {
    comparison.rig().run();
    float both[2] = {0.0f, 0.0f};
    bool draws = false;  // rays come first
    for (const auto& timing : comparison.rig().plan().timings()) {
      draws |= timing.name == "gbuffer.triangles";
      both[draws] += std::max(timing.milliseconds, 0.0f);
    }
    traced = std::min(traced, both[0]);
    drawn = std::min(drawn, both[1]);
  }
  std::printf("rays %.2f ms, drawn %.2f ms, ratio %.1f\n", traced, drawn, traced / drawn);
  EXPECT_LT(drawn, traced);
}

}  // namespace
}  // namespace heliograph::test
