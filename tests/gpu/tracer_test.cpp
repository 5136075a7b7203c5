#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/import.hpp"
#include "tests/support/traced_scene.hpp"
#include "tracing/tracer_choice.hpp"

namespace heliograph::tracing {
namespace {

using namespace heliograph::test;

constexpr float untouched = -7.0f;

struct Answers {
  std::vector<shared::Hit> hits;
  std::vector<std::uint32_t> occluded;
};

/// A scene on the device as one tracer sees it.
class TracedScene {
 public:
  TracedScene(const gpu::Device& device, const RayTracer& tracer, const scene::Scene& scene)
      : device_(device), tracer_(tracer) {
    buffers_.alpha_heap =
        gpu::upload_buffer(device, "alpha masks", std::as_bytes(std::span(scene.alpha_heap)),
                           VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    structure_ = tracer.build(scene, buffers_);
  }

  /// Traces the first `count` of the rays; answers beyond them come back as they were.
  Answers trace(std::span<const shared::Ray> rays, std::uint32_t count) const {
    const auto capacity = static_cast<std::uint32_t>(rays.size());
    constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    gpu::FramePlan plan(device_, {1, 1});
    const RayStream stream{
        plan.buffer("count", sizeof(shared::RayCount),
                    storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, gpu::Memory::upload),
        plan.buffer("rays", rays.size_bytes(), storage, gpu::Memory::upload), capacity};
    const auto hits =
        plan.buffer("hits", capacity * sizeof(shared::Hit), storage, gpu::Memory::readback);
    const auto occluded =
        plan.buffer("occluded", capacity * sizeof(std::uint32_t), storage, gpu::Memory::readback);
    tracer_.trace_closest(plan, "closest", *structure_, stream, hits);
    tracer_.trace_any(plan, "any", *structure_, stream, occluded);
    plan.compile();

    Answers answers{std::vector(capacity, shared::Hit{untouched, 0, 0, 0, 0, 0, 0, 0}),
                    std::vector(capacity, 7u)};
    const shared::RayCount header{count, (count + 63) / 64, 1, 1};
    std::memcpy(plan.get(stream.count).mapped(), &header, sizeof(header));
    std::memcpy(plan.get(stream.rays).mapped(), rays.data(), rays.size_bytes());
    const auto hit_bytes = std::as_writable_bytes(std::span(answers.hits));
    const auto occluded_bytes = std::as_writable_bytes(std::span(answers.occluded));
    std::memcpy(plan.get(hits).mapped(), hit_bytes.data(), hit_bytes.size());
    std::memcpy(plan.get(occluded).mapped(), occluded_bytes.data(), occluded_bytes.size());
    plan.execute();
    std::memcpy(hit_bytes.data(), plan.get(hits).mapped(), hit_bytes.size());
    std::memcpy(occluded_bytes.data(), plan.get(occluded).mapped(), occluded_bytes.size());
    return answers;
  }

  Answers trace(std::span<const shared::Ray> rays) const {
    return trace(rays, static_cast<std::uint32_t>(rays.size()));
  }

 private:
  const gpu::Device& device_;
  const RayTracer& tracer_;
  SceneBuffers buffers_;
  std::shared_ptr<const AccelerationStructure> structure_;
};

gpu::DeviceOptions device_options() {
  const char* device = std::getenv("HELIOGRAPH_TEST_DEVICE");
  return {.wanted = device ? device : "", .cache_folder = {}};
}

/// The tests' device with every tracer that it offers.
struct Rig {
  Rig() {
    for (const protocol::TracerKind kind : offered_tracers(device.report())) {
      tracers.emplace(kind, make_tracer(kind, device));
    }
  }

  gpu::Instance instance{true};
  gpu::Device device{instance, device_options()};
  std::map<protocol::TracerKind, std::unique_ptr<RayTracer>> tracers;
};

class TracersTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { rig_ = std::make_unique<Rig>(); }
  static void TearDownTestSuite() { rig_.reset(); }
  void TearDown() override {
    EXPECT_EQ(rig_->instance.validation_messages(), 0u) << "the validation layers complained";
  }

  static bool offered(protocol::TracerKind kind) { return rig_->tracers.contains(kind); }
  static std::string lacking(protocol::TracerKind kind) {
    return rig_->device.report().name + " (" + rig_->device.report().driver +
           ") does not offer the tracer " + std::string(protocol::enum_name(kind));
  }
  static TracedScene traced(const scene::Scene& scene, protocol::TracerKind kind) {
    return {rig_->device, *rig_->tracers.at(kind), scene};
  }

  static std::unique_ptr<Rig> rig_;
};

std::unique_ptr<Rig> TracersTest::rig_;

class TracerTest : public TracersTest, public testing::WithParamInterface<protocol::TracerKind> {
 protected:
  void SetUp() override {
    if (!offered(GetParam())) GTEST_SKIP() << lacking(GetParam());
  }
};

/// Share of rays with different answers.
double disagreement(const Answers& a, const Answers& b) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.hits.size(); ++i) {
    different += !same_hit(a.hits[i], b.hits[i]) || a.occluded[i] != b.occluded[i];
  }
  return static_cast<double>(different) / static_cast<double>(a.hits.size());
}

std::size_t hit_count(const Answers& answers) {
  std::size_t count = 0;
  for (const shared::Hit& hit : answers.hits) count += hit.instance != shared::hit_none;
  return count;
}

Answers search(const scene::Scene& scene, std::span<const shared::Ray> rays) {
  Answers answers;
  for (const shared::Ray& ray : rays) {
    answers.hits.push_back(closest_by_search(scene, ray));
    answers.occluded.push_back(answers.hits.back().instance != shared::hit_none ? 1 : 0);
  }
  return answers;
}

TEST_P(TracerTest, AgreesWithAskingEveryTriangle) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const scene::Scene scene = two_level_scene(seed);
    const std::vector<shared::Ray> rays = random_rays(scene, 5000, seed);
    const Answers expected = search(scene, rays);
    const Answers answers = traced(scene, GetParam()).trace(rays);
    EXPECT_GT(hit_count(expected), rays.size() / 6) << "a test without hits shows nothing";
    EXPECT_LT(hit_count(expected), rays.size() * 3 / 4);
    EXPECT_LT(disagreement(answers, expected), 1e-3) << "seed " << seed;
  }
}

TEST_P(TracerTest, BarycentricsAndDistanceNameTheSamePoint) {
  const scene::Scene scene = two_level_scene(4);
  const std::vector<shared::Ray> rays = random_rays(scene, 5000, 4);
  const Answers answers = traced(scene, GetParam()).trace(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const shared::Hit& hit = answers.hits[i];
    if (hit.instance == shared::hit_none) {
      EXPECT_EQ(hit.t, rays[i].t_max);
      continue;
    }
    ASSERT_LT(hit.instance, scene.instances.size());
    const auto& [mesh_index, node] = scene.instances[hit.instance];
    const scene::Mesh& mesh = scene.meshes[mesh_index];
    ASSERT_LT(hit.triangle, mesh.indices.size() / 3);
    const auto corner = [&](std::size_t c) {
      return mesh.vertices[mesh.indices[3 * std::size_t(hit.triangle) + c]].position;
    };
    const glm::vec3 point =
        (1.0f - hit.u - hit.v) * corner(0) + hit.u * corner(1) + hit.v * corner(2);
    const glm::vec3 world = glm::vec3(scene.nodes[node].world * glm::vec4(point, 1.0f));
    EXPECT_LT(glm::distance(world, rays[i].origin + hit.t * rays[i].direction), 1e-4f);
    EXPECT_GT(hit.t, rays[i].t_min);
    EXPECT_LT(hit.t, rays[i].t_max);
  }
}

/// Straight down on the quad, many to a texel.
std::vector<shared::Ray> rays_from_above() {
  std::vector<shared::Ray> rays;
  for (int z = 0; z < 90; ++z) {
    for (int x = 0; x < 150; ++x) {
      shared::Ray ray{};
      ray.origin = {(static_cast<float>(x) + 0.5f) / 75.0f - 1.0f, 1.0f,
                    (static_cast<float>(z) + 0.5f) / 45.0f - 1.0f};
      ray.direction = {0, -1, 0};
      ray.t_max = 10.0f;
      rays.push_back(ray);
    }
  }
  return rays;
}

TEST_P(TracerTest, MasksLetRaysThroughTexelByTexel) {
  const std::vector<shared::Ray> rays = rays_from_above();
  for (std::uint32_t wrap_s = shared::wrap_repeat; wrap_s <= shared::wrap_mirror; ++wrap_s) {
    for (std::uint32_t wrap_t = shared::wrap_repeat; wrap_t <= shared::wrap_mirror; ++wrap_t) {
      scene::Scene scene;
      const shared::Material material = masked_material(scene, wrap_s, wrap_t);
      place(scene, add_mesh(scene, quad(), material), glm::mat4(1.0f));
      const Answers expected = search(scene, rays);
      EXPECT_GT(hit_count(expected), rays.size() / 4);
      EXPECT_LT(hit_count(expected), rays.size() * 3 / 4);
      EXPECT_EQ(disagreement(traced(scene, GetParam()).trace(rays), expected), 0.0)
          << "wrap " << wrap_s << ", " << wrap_t;
    }
  }
}

TEST_P(TracerTest, AnswersOnlyTheRaysThatAreCounted) {
  const scene::Scene scene = two_level_scene(5);
  const std::vector<shared::Ray> rays = random_rays(scene, 1000, 5);
  const TracedScene subject = traced(scene, GetParam());
  for (const std::uint32_t count : {0u, 1u, 63u, 257u, 999u}) {
    const Answers answers = subject.trace(rays, count);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(answers.hits[i].t == untouched, i >= count) << i << " of " << count;
      EXPECT_EQ(answers.occluded[i] == 7, i >= count) << i << " of " << count;
    }
  }
}

TEST_P(TracerTest, MissesEverythingInAnEmptyScene) {
  const std::vector<shared::Ray> rays = random_rays({}, 300, 6);
  EXPECT_EQ(hit_count(traced({}, GetParam()).trace(rays)), 0u);
}

TEST_P(TracerTest, MissesWithRaysThatReachNowhere) {
  const scene::Scene scene = two_level_scene(7);
  std::vector<shared::Ray> rays = random_rays(scene, 600, 7);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].t_max = i % 3 == 0 ? rays[i].t_min : i % 3 == 1 ? 0.0f : -1e30f;
  }
  const Answers answers = traced(scene, GetParam()).trace(rays);
  EXPECT_EQ(hit_count(answers), 0u);
  for (const std::uint32_t occluded : answers.occluded) EXPECT_EQ(occluded, 0u);
}

TEST_P(TracerTest, LeavesOutBothEndsOfTheInterval) {
  scene::Scene scene;
  place(scene, add_mesh(scene, quad(), plain_material()), glm::mat4(1.0f));
  const shared::Ray down{{0.25f, 2, 0.5f}, 0.0f, {0, -1, 0}, 10.0f, 0, 0, 0, 0};
  std::vector<shared::Ray> rays(5, down);
  rays[0].t_max = 2.0f;
  rays[1].t_min = 2.0f;
  rays[2].t_min = std::nextafter(2.0f, 0.0f);
  rays[3].t_max = std::nextafter(2.0f, 3.0f);
  rays[4].origin.y = 0.0f;  // starts on the surface
  const Answers answers = traced(scene, GetParam()).trace(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool within = i == 2 || i == 3;
    EXPECT_EQ(answers.hits[i].instance == 0, within) << "ray " << i;
    EXPECT_EQ(answers.occluded[i], within ? 1u : 0u) << "ray " << i;
  }
}

TEST_P(TracerTest, DoesNotMeetFlatInstancesAndCornersWithoutAPlace) {
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, quad(), plain_material());
  place(scene, mesh, glm::scale(glm::mat4(1.0f), glm::vec3(1, 1, 0)));
  scene::Mesh torn = quad();
  torn.vertices[1].position.y = std::numeric_limits<float>::infinity();
  torn.vertices[3].position.x = std::numeric_limits<float>::quiet_NaN();
  place(scene, add_mesh(scene, torn, plain_material()), glm::mat4(1.0f));
  scene.bounds = {glm::vec3(-1.0f), glm::vec3(1.0f)};
  EXPECT_EQ(hit_count(traced(scene, GetParam()).trace(random_rays(scene, 500, 9))), 0u);
}

TEST_P(TracerTest, SeesBothFacesOfMirroredInstances) {
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, quad(), plain_material());
  place(scene, mesh, glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1)));
  std::vector<shared::Ray> rays(2);
  rays[0] = {{0.25f, 2, 0.5f}, 0.0f, {0, -1, 0}, 10.0f, 0, 0, 0, 0};
  rays[1] = {{0.25f, -2, 0.5f}, 0.0f, {0, 1, 0}, 10.0f, 0, 0, 0, 0};
  const Answers answers = traced(scene, GetParam()).trace(rays);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(answers.hits[i].instance, 0u);
    EXPECT_FLOAT_EQ(answers.hits[i].t, 2.0f);
    EXPECT_EQ(answers.occluded[i], 1u);
  }
}

INSTANTIATE_TEST_SUITE_P(, TracerTest, testing::ValuesIn(all_tracers), [](const auto& test) {
  switch (test.param) {
    case protocol::TracerKind::embree:
      return "Embree";
    case protocol::TracerKind::software:
      return "Software";
    case protocol::TracerKind::ray_query:
      return "RayQuery";
    default:
      return "RayPipeline";
  }
});

class AssetTest : public TracersTest {
 protected:
  static void expect_agreement(const char* file) {
    const char* assets = std::getenv("HELIOGRAPH_TEST_ASSETS");
    if (!assets) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS names no folder of scenes";
    const scene::Scene scene = scene::import_gltf(std::filesystem::path(assets) / file);
    const std::vector<shared::Ray> rays = random_rays(scene, 200'000, 8);
    const Answers expected = traced(scene, protocol::TracerKind::software).trace(rays);
    EXPECT_GT(hit_count(expected), rays.size() / 50);
    for (const auto& [kind, tracer] : rig_->tracers) {
      const double share = disagreement(traced(scene, kind).trace(rays), expected);
      RecordProperty(std::string(protocol::enum_name(kind)), std::to_string(share));
      EXPECT_LT(share, 1e-3) << protocol::enum_name(kind) << " against software";
    }
  }
};

TEST_F(TracersTest, WhatIsNotOfferedIsRefused) {
  for (const protocol::TracerKind kind : all_tracers) {
    if (offered(kind)) continue;
    EXPECT_THROW(make_tracer(kind, rig_->device), gpu::GpuError) << protocol::enum_name(kind);
  }
}

TEST_F(AssetTest, TracersAgreeOnAHelmet) {
  expect_agreement("gltf/DamagedHelmet.glb");
}

TEST_F(AssetTest, TracersAgreeInAnAtrium) {
  expect_agreement("standins/glossy_sponza_1.glb");
}

}  // namespace
}  // namespace heliograph::tracing
