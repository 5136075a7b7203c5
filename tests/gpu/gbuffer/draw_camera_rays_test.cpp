#include "render/passes/gbuffer/draw_camera_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/ext/matrix_transform.hpp>
#include <string>
#include <vector>

#include "render/passes/formats.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "scene/import.hpp"
#include "shaders/shared/drawn.h"
#include "tests/gpu/embedded.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/gpu/support/textured_scene.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t many_parts = 1u << 14;

/// tests/gpu/gbuffer/drawn_hits.comp
template <class Stage>
struct DrawnHitsBindings {
  render::WalkedBuffers<Stage> hierarchy;
  render::DrawnHits<Stage> found;
  gpu::WriteBuffer<Stage, shared::Hit> hits;
};

/// What the camera rays of one view hit: traced and drawn.
class TracedAndDrawn {
 public:
  TracedAndDrawn(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera,
                 VkExtent2D extent, std::uint32_t most_parts = many_parts)
      : rig_(std::move(scene), camera, {.extent = extent, .tracer = "software"}) {
    gpu::FramePlan& plan = rig_.plan();
    const render::FrameInputs& in = with_host_kernels(rig_, false);
    const render::kernels::Rows rows{0, static_cast<int>(extent.height)};
    rays_ = render::camera_ray_capacity(extent.width, rows);
    const auto buffer = [&](const char* name) {
      return plan.buffer(name, sizeof(shared::Hit) * rays_, render::formats::storage,
                         gpu::Memory::readback);
    };
    traced_ = buffer("traced");
    drawn_ = buffer("drawn");
    const auto stream = render::declare_rays(plan, "stream", rays_, tracing::RayKind::camera);
    render::camera_rays(plan, in, "stream.rays", stream, rows);
    in.tracer.trace_closest(plan, "stream.trace", in.structure, stream, traced_);
    const auto hierarchy = in.tracer.walked(in.structure);
    flat_ = hierarchy.value().flat;
    const auto buffers = render::walked_buffers(plan, *hierarchy);
    const gpu::BufferRef beside = plan.buffer("beside", sizeof(shared::Hit) * rays_,
                                              render::formats::storage, gpu::Memory::device);
    const render::DrawnHits<gpu::Declared> found =
        render::draw_camera_rays(plan, in, *hierarchy, buffers, beside, most_parts);
    plan.pass("drawn", in.program(test::shaders::drawn_hits))
        .bind<DrawnHitsBindings>({.hierarchy = buffers, .found = found, .hits = drawn_})
        .dispatch(gpu::each_pixel());
  }

  FrameRig& rig() { return rig_; }
  const tracing::WalkedHierarchy::Flat& flat() const { return flat_; }

  /// @returns the part of all rays that hit something
  double expect_equal(const std::string& which) {
    rig_.run();
    const std::vector<shared::Hit> traced = hits(traced_), drawn = hits(drawn_);
    std::size_t met = 0, lost = 0, met_more = 0, other_triangles = 0;
    for (std::size_t i = 0; i < traced.size(); ++i) {
      const shared::Hit &a = traced[i], &b = drawn[i];
      if (a.instance == shared::hit_none) {
        met_more += b.instance != shared::hit_none;
        continue;
      }
      ++met;
      if (std::abs(a.t - b.t) > 1e-5f * a.t) {
        ++lost;
      } else if (a.instance != b.instance || a.triangle != b.triangle) {
        ++other_triangles;
      } else {
        EXPECT_LE(std::max(std::abs(a.u - b.u), std::abs(a.v - b.v)), 1e-4f) << which;
      }
    }
    EXPECT_EQ(lost, 0u) << which << ", of " << met;
    // Past the boxes of a hierarchy whose places have few digits.
    EXPECT_LE(static_cast<double>(met_more), 1e-3 * static_cast<double>(met)) << which;
    // Where two triangles meet.
    EXPECT_LE(static_cast<double>(other_triangles), 0.01 * static_cast<double>(met)) << which;
    return static_cast<double>(met) / static_cast<double>(traced.size());
  }

  /// In how many tiles rays were traced beside what is drawn, or in place of it.
  std::size_t traced_tiles() {
    std::size_t count = 0;
    const std::vector<shared::Hit> drawn = hits(drawn_);
    for (std::size_t i = 0; i < drawn.size(); i += shared::tile_pixels) {
      count += drawn[i].padding0 != shared::tile_drawn;
    }
    return count;
  }
  std::size_t tiles() const { return rays_ / shared::tile_pixels; }

  /// Pixels that show instances of this mesh.
  std::size_t shown(const scene::Scene& scene, std::uint32_t mesh) {
    const std::vector<shared::Hit> drawn = hits(drawn_);
    return static_cast<std::size_t>(std::ranges::count_if(drawn, [&](const shared::Hit& hit) {
      return hit.instance != shared::hit_none && scene.instances[hit.instance].mesh == mesh;
    }));
  }

  /// Part of the frame alone, as dynamic resolution does.
  void draw_smaller(VkExtent2D drawn, const scene::Camera& camera) {
    rig_.draw_smaller(drawn, camera);
    rays_ = render::camera_ray_capacity(drawn.width, {0, static_cast<int>(drawn.height)});
  }

 private:
  std::vector<shared::Hit> hits(gpu::BufferRef from) {
    std::vector<shared::Hit> hits(rays_);
    std::memcpy(hits.data(), rig_.plan().get(from).mapped(), sizeof(shared::Hit) * rays_);
    return hits;
  }

  FrameRig rig_;
  std::uint32_t rays_;
  gpu::BufferRef traced_, drawn_;
  tracing::WalkedHierarchy::Flat flat_;
};

class DrawCameraRays : public testing::Test {
 protected:
  void SetUp() override {
    if (!device().atomics_64()) GTEST_SKIP() << "no atomic operations on 64-bit integers";
  }
};

/// A room of large quads, wall by wall, with a sphere of many triangles: around its middle.
std::shared_ptr<const scene::Scene> room() {
  SceneBuilder builder;
  const auto wall = builder.add_quad({{{-4, -4, -4}, {4, -4, -4}, {4, 4, -4}, {-4, 4, -4}}},
                                     surface({0.5f, 0.5f, 0.5f}));
  for (const glm::vec3& axis : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const float angle = glm::radians(90.0f * static_cast<float>(quarter));
      builder.place(wall, glm::rotate(glm::mat4(1.0f), angle, axis));
    }
  }
  const auto sphere = builder.add_sphere(0.7f, surface({0.2f, 0.8f, 0.3f}));
  builder.place(sphere, glm::translate(glm::mat4(1.0f), {0.5f, -0.4f, -2.0f}));
  // Around the camera: a corner of every triangle is behind it.
  builder.place(builder.add_quad({{{-9, -0.3f, 9}, {9, -0.3f, 9}, {9, -0.3f, -3}, {-9, -0.3f, -3}}},
                                 surface({0.7f, 0.4f, 0.1f})));
  return builder.build();
}

/// Rays meet backs that drawing leaves out.
std::shared_ptr<const scene::Scene> double_sided(const scene::Scene& scene) {
  auto copy = std::make_shared<scene::Scene>(scene);
  for (shared::Material& material : copy->materials) {
    material.flags |= shared::material_double_sided;
  }
  return copy;
}

TEST_F(DrawCameraRays, FindsWhatRaysHit) {
  for (const bool orthographic : {false, true}) {
    for (const auto& [name, scene] :
         {std::pair("textured", double_sided(*textured_scene())),
          std::pair("transparent", double_sided(*transparent_scene()))}) {
      scene::Camera camera = scene::fit_camera(scene->bounds, 40.0f, 1.5f);
      if (orthographic) camera.orthographic_height = 2.2f * scene->bounds.radius();
      TracedAndDrawn both(scene, camera, {150, 100});
      both.rig().set_view(camera, 3);
      const double met =
          both.expect_equal(std::string(name) + (orthographic ? ", orthographic" : ""));
      EXPECT_GT(met, 0.1) << name;
      EXPECT_TRUE(both.flat().all);
    }
  }
}

TEST_F(DrawCameraRays, CutsTrianglesAtTheNearPlane) {
  const auto scene = room();
  for (const glm::vec3& target : {glm::vec3(0.3f, -0.2f, -1),
                                  {1, -0.4f, 0.2f},
                                  {0.1f, -1, 0.1f},
                                  {0.1f, 1, 0.3f},
                                  {-0.6f, 0.1f, 0.9f}}) {
    TracedAndDrawn both(scene, look({0, 0, 0}, target, 70.0f), {333, 187});
    EXPECT_GT(both.expect_equal("toward " + std::to_string(target.x)), 0.9);
  }
}

/// A floor of so many strips beside each other, which lie along Z.
std::shared_ptr<const scene::Scene> strips(int count, float width, float length,
                                           const glm::vec3& middle) {
  SceneBuilder builder;
  std::vector<std::array<glm::vec3, 4>> quads;
  for (int i = -count / 2; i < count / 2; ++i) {
    const float left = width * static_cast<float>(i), right = left + width;
    quads.push_back(
        {{{left, 0, length}, {right, 0, length}, {right, 0, -length}, {left, 0, -length}}});
  }
  builder.place(builder.add_quads(quads, surface(glm::vec3(0.5f))),
                glm::translate(glm::mat4(1.0f), middle));
  return builder.build();
}

TEST_F(DrawCameraRays, LosesNoPixelsAlongLongEdges) {
  const glm::vec3 eye(0.013f, 0.2f, 0.3f);
  TracedAndDrawn both(strips(120, 0.05f, 3000.0f, {}),
                      look(eye, eye + glm::vec3(0.07f, -0.6f, -0.71f), 60.0f), {960, 540}, 1 << 18);
  both.expect_equal("strips of 6 km");
}

// Where places have few digits left.
TEST_F(DrawCameraRays, LosesNoPixelsFarFromTheOrigin) {
  const glm::vec3 middle(100000, 0, -100000);
  const glm::vec3 eye = middle + glm::vec3(0.3f, 1.7f, 0.3f);
  for (const bool orthographic : {false, true}) {
    scene::Camera camera = look(eye, eye + glm::vec3(0.07f, -0.6f, -0.71f), 60.0f);
    if (orthographic) camera.orthographic_height = 5.0f;
    TracedAndDrawn both(strips(60, 0.25f, 8.0f, middle), camera, {480, 270});
    both.expect_equal(orthographic ? "orthographic" : "perspective");
  }
}

TEST_F(DrawCameraRays, WorksAtAnySize) {
  const auto scene = room();
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {65, 129}, {130, 1}}) {
    TracedAndDrawn both(scene, look({0, 0, 0}, {0.3f, -0.2f, -1}), extent);
    both.expect_equal(std::to_string(extent.width) + " x " + std::to_string(extent.height));
  }
}

/// The room with `count` more spheres inside and outside of it, which a clip moves.
std::shared_ptr<const scene::Scene> room_of_moving_spheres(int count) {
  SceneBuilder builder;
  const auto wall = builder.add_quad({{{-4, -4, -4}, {4, -4, -4}, {4, 4, -4}, {-4, 4, -4}}},
                                     surface({0.5f, 0.5f, 0.5f}));
  builder.place(wall);
  builder.place(builder.add_sphere(1.0f, surface({0.2f, 0.8f, 0.3f})),
                glm::translate(glm::mat4(1.0f), {-1.5f, 0.5f, -2.5f}));
  const auto ball = builder.add_sphere(0.15f, surface({0.9f, 0.3f, 0.3f}));
  for (int i = 0; i < count; ++i) {
    const float turn = 2.4f * static_cast<float>(i);
    const float far = 0.5f + 6.0f * static_cast<float>(i) / static_cast<float>(count);
    builder.place(
        ball, glm::translate(glm::mat4(1.0f), {far * std::sin(turn), 0.4f * std::cos(1.7f * turn),
                                               far * std::cos(turn)}));
  }
  auto scene = std::make_shared<scene::Scene>(*double_sided(*builder.build()));
  scene::Clip& clip = scene->clips.emplace_back();
  for (const scene::Instance& instance : scene->instances) {
    if (instance.mesh == ball) clip.channels.push_back({.node = instance.node});
  }
  return scene;
}

// Their boxes are in front of the camera and behind it, and around it.
TEST_F(DrawCameraRays, TracesTilesThatMayShowWhatMoves) {
  std::size_t traced_tiles = 0;
  for (const int count : {1, 5, 150}) {
    const auto scene = room_of_moving_spheres(count);
    for (const bool orthographic : {false, true}) {
      for (const float turn : {0.0f, 1.0f, 2.6f}) {
        scene::Camera camera = look({0, 0, 0}, {std::sin(turn), -0.1f, -std::cos(turn)}, 60.0f);
        if (orthographic) camera.orthographic_height = 3.0f;
        TracedAndDrawn both(scene, camera, {301, 203});
        EXPECT_FALSE(both.flat().all);
        both.expect_equal(std::to_string(count) + " spheres, turned by " + std::to_string(turn) +
                          (orthographic ? ", orthographic" : ""));
        EXPECT_LT(both.traced_tiles(), both.tiles() * (count < 100 ? 1 : 2) / 2);
        traced_tiles += both.traced_tiles();
        if (count == 150) {
          EXPECT_GT(both.shown(*scene, scene->instances.back().mesh), 0u);
        }
      }
    }
  }
  EXPECT_GT(traced_tiles, 0u);
}

TEST_F(DrawCameraRays, FindsTilesOfSmallerFrames) {
  const auto scene = room_of_moving_spheres(40);
  const scene::Camera camera = look({0, 0, 0}, {0.2f, -0.1f, -1}, 60.0f);
  TracedAndDrawn both(scene, camera, {301, 203});
  both.draw_smaller({199, 135}, camera);
  both.expect_equal("two thirds");
  EXPECT_GT(both.shown(*scene, scene->instances.back().mesh), 0u);
  EXPECT_LT(both.traced_tiles(), both.tiles());
}

TEST_F(DrawCameraRays, TracesAllTilesWhereManyInstancesMove) {
  TracedAndDrawn both(room_of_moving_spheres(1100), look({0, 0, 0}, {0.2f, -0.1f, -1}, 60.0f),
                      {90, 70});
  both.expect_equal("1100 spheres");
  EXPECT_EQ(both.traced_tiles(), both.tiles());
}

TEST_F(DrawCameraRays, TracesFramesWithTooManyParts) {
  for (const auto& [name, scene] :
       {std::pair("still", room()), std::pair("moving", room_of_moving_spheres(20))}) {
    for (const std::uint32_t most_parts : {0u, 1u, 5u}) {
      TracedAndDrawn both(scene, look({0, 0, 0}, {0.3f, -0.2f, -1}, 70.0f), {200, 140}, most_parts);
      both.expect_equal(std::string(name) + ", " + std::to_string(most_parts) + " parts");
      EXPECT_EQ(both.traced_tiles(), both.tiles());
    }
  }
}

// Nothing but what is drawn.
TEST_F(DrawCameraRays, TracesNoTilesOfWhatDoesNotMove) {
  TracedAndDrawn both(room(), look({0, 0, 0}, {0.3f, -0.2f, -1}, 70.0f), {200, 140});
  both.expect_equal("room");
  EXPECT_EQ(both.traced_tiles(), 0u);
}

TEST_F(DrawCameraRays, TracesInstancesThatMove) {
  const char* assets = std::getenv("HELIOGRAPH_TEST_ASSETS");
  if (!assets) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene =
      double_sided(scene::import_gltf(std::filesystem::path(assets) / "gltf" / "BoxAnimated.glb"));
  const scene::Camera camera = scene::fit_camera(scene->bounds, 40.0f, 1.5f);
  TracedAndDrawn both(scene, camera, {120, 80});
  EXPECT_GT(both.flat().count, 0u);
  EXPECT_FALSE(both.flat().all);
  for (const double seconds : {0.0, 1.2, 2.5}) {
    both.rig().moving().set_pose(&scene->clips.at(0), seconds);
    both.rig().moving().advance();
    both.rig().set_view(camera);
    EXPECT_GT(both.expect_equal("at " + std::to_string(seconds)), 0.1);
  }
}

}  // namespace
}  // namespace heliograph::test
