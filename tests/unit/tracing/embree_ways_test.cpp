// What every way to build a scene and to trace rays in it has in common.
#include "tests/unit/tracing/embree_ways.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <thread>

#include "scene/import.hpp"

namespace heliograph::tracing {
namespace {

using namespace heliograph::test;

/// Ends the process when it is not destroyed in time: a call into Embree cannot be interrupted.
class TimeLimit {
 public:
  explicit TimeLimit(std::chrono::seconds most)
      : watch_([this, most] {
          std::unique_lock lock(mutex_);
          if (ended_.wait_for(lock, most, [this] { return done_; })) return;
          std::fprintf(stderr, "rays still travel after %ld s\n", static_cast<long>(most.count()));
          std::abort();
        }) {}
  ~TimeLimit() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    ended_.notify_one();
    watch_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::thread watch_;
};

class EmbreeWays : public testing::TestWithParam<Way> {};

struct ClosedSphere {
  scene::Scene scene;
  glm::mat4 world{1.0f};
};

ClosedSphere closed_sphere(bool moved) {
  ClosedSphere sphere;
  if (moved) {
    sphere.world = glm::translate(glm::mat4(1.0f), {13.1f, -7.7f, 31.3f});
    sphere.world = glm::rotate(sphere.world, 0.7f, glm::normalize(glm::vec3(1, 2, 3)));
    sphere.world = glm::scale(sphere.world, {1.3f, 0.9f, 1.1f});
  }
  place(sphere.scene, add_mesh(sphere.scene, test::sphere(24), plain_material()), sphere.world);
  return sphere;
}

glm::vec3 point_inside(const ClosedSphere& sphere, Random& random) {
  return glm::vec3(sphere.world * glm::vec4(uniform_vector(random, 0.5f), 1.0f));
}

std::ptrdiff_t rays_outside(const TraceResults& results) {
  return std::ranges::count(results.hits, shared::hit_none, &shared::Hit::instance) +
         std::ranges::count(results.occluded, 0u);
}

TEST_P(EmbreeWays, RandomRaysStayInAClosedMesh) {
  for (const bool moved : {false, true}) {
    const ClosedSphere sphere = closed_sphere(moved);
    Random random(21);
    std::vector<shared::Ray> rays(40'000);
    for (shared::Ray& ray : rays) {
      const glm::vec3 direction = uniform_vector(random, 1.0f);
      ray = {point_inside(sphere, random), 0.0f, glm::normalize(direction), 1e6f, 0, 0, 0, 0};
    }
    EXPECT_EQ(rays_outside(WayThrough(sphere.scene, GetParam()).trace(rays)), 0);
  }
}

// Fast scenes let some of these rays through; see EmbreeScene::scenes().
TEST_P(EmbreeWays, RaysAtEdgesStayInARobustMesh) {
  if (!GetParam().robust) GTEST_SKIP() << "not robust";
  for (const bool moved : {false, true}) {
    const ClosedSphere sphere = closed_sphere(moved);
    const scene::Mesh& mesh = sphere.scene.meshes[0];
    Random random(22);
    std::vector<shared::Ray> rays(40'000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::size_t triangle = random() % (mesh.indices.size() / 3);
      const auto corner = [&](std::size_t c) {
        const std::uint32_t index = mesh.indices[3 * triangle + c % 3];
        return glm::vec3(sphere.world * glm::vec4(mesh.vertices[index].position, 1.0f));
      };
      const glm::vec3 target = glm::mix(corner(i), corner(i + 1), uniform(random, 0.0f, 1.0f));
      const glm::vec3 origin = point_inside(sphere, random);
      rays[i] = {origin, 0.0f, glm::normalize(target - origin), 1e6f, 0, 0, 0, 0};
    }
    EXPECT_EQ(rays_outside(WayThrough(sphere.scene, GetParam()).trace(rays)), 0);
  }
}

/// Quads in coordinate planes at whole coordinates.
scene::Scene aligned_quads() {
  Random random(23);
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, quad(), plain_material());
  for (int i = 0; i < 60; ++i) {
    const auto whole = [&] { return static_cast<float>(random() % 9) - 4.0f; };
    const glm::vec3 position(whole(), whole(), whole());
    glm::mat4 world = glm::translate(glm::mat4(1.0f), position);
    const glm::vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    world = glm::rotate(world, 1.57079633f, axes[i % 3]);
    place(scene, mesh, world);
  }
  return scene;
}

// Embree 3.13 traces coherent any-hit streams along an axis through instances without end.
TEST_P(EmbreeWays, RaysAlongAxesEnd) {
  const scene::Scene scene = aligned_quads();
  std::vector<shared::Ray> rays;
  std::vector<bool> clear;  // passes all edges and planes at a distance
  for (int i = 0; i < 19 * 19 * 19; ++i) {
    // Quads have edges and diagonals at multiples of a half.
    const glm::ivec3 step(i % 19, i / 19 % 19, i / 361);
    const float offset = i % 2 ? 0.21f : 0.0f;
    const glm::vec3 origin = 0.5f * glm::vec3(step) - 4.5f + offset * glm::vec3(1.0f, 1.3f, 1.7f);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {-1.0f, 1.0f}) {
        glm::vec3 direction(0.0f);
        direction[axis] = sign;
        rays.push_back({origin, 0.0f, direction, axis == 1 ? 2.7f : 1e30f, 0, 0, 0, 0});
        clear.push_back(offset > 0.0f);
      }
    }
  }
  const TimeLimit limit(std::chrono::seconds(60));
  const TraceResults results = WayThrough(scene, GetParam()).trace(rays);
  int wrong = 0;
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); i += 7) {
    if (!clear[i]) continue;
    const shared::Hit expected = closest_hit_brute_force(scene, rays[i]);
    hits += expected.instance != shared::hit_none;
    wrong += !same_hit(results.hits[i], expected) ||
             (results.occluded[i] != 0) != (expected.instance != shared::hit_none);
  }
  EXPECT_GT(hits, 500);
  EXPECT_EQ(wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(, EmbreeWays, testing::ValuesIn(all_ways()), way_name);

class EmbreeWaysOfFile : public testing::TestWithParam<const char*> {};

// At grazing angles and at silhouettes other arithmetic may decide otherwise.
TEST_P(EmbreeWaysOfFile, HitTheSame) {
  const char* assets = std::getenv("HELIOGRAPH_TEST_ASSETS");
  if (!assets) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const scene::Scene scene = scene::import_gltf(std::filesystem::path(assets) / GetParam());
  const std::vector<shared::Ray> rays = random_rays(scene, 100'000, 24);
  const TraceResults expected = WayThrough(scene, reference_way).trace(rays);
  for (const Way& way : all_ways()) {
    const TraceResults results = WayThrough(scene, way).trace(rays);
    int sides = 0, elsewhere = 0, occlusion = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const shared::Hit &a = results.hits[i], &b = expected.hits[i];
      const bool hit = a.instance != shared::hit_none, other = b.instance != shared::hit_none;
      sides += hit != other;
      elsewhere += hit && other && std::abs(a.t - b.t) > 1e-4f * std::max(a.t, b.t);
      occlusion += results.occluded[i] != expected.occluded[i];
    }
    std::printf("%s, %s: of %zu rays %d hit or miss otherwise, %d hit elsewhere, %d occluded\n",
                GetParam(), name_of(way).c_str(), rays.size(), sides, elsewhere, occlusion);
    const int most = static_cast<int>(rays.size() / 10'000);
    EXPECT_LE(sides, most) << name_of(way);
    EXPECT_LE(elsewhere, most) << name_of(way);
    EXPECT_LE(occlusion, most) << name_of(way);
  }
}

INSTANTIATE_TEST_SUITE_P(, EmbreeWaysOfFile,
                         testing::Values("standins/glossy_sponza_1.glb",
                                         "standins/breakfast_room.glb", "gltf/DamagedHelmet.glb",
                                         "gltf/sponza_positions_only.glb"),
                         [](const auto& test) {
                           return std::filesystem::path(test.param).stem().string();
                         });

}  // namespace
}  // namespace heliograph::tracing
