#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/kernels/common/ray_sink.hpp"
#include "tests/support/traced_scene.hpp"
#include "tracing/tracer_choice.hpp"

/// Shared by the tests of tracers: all tracers of the device, and rays through each.
namespace heliograph::tracing {

using namespace heliograph::test;

inline constexpr float untouched = -7.0f;

struct TraceResults {
  std::vector<shared::Hit> hits;
  std::vector<std::uint32_t> occluded;
};

/// A frame plan that traces one ray stream repeatedly.
class Tracing {
 public:
  Tracing(const gpu::Device& device, const RayTracer& tracer,
          const AccelerationStructure& structure, std::size_t capacity,
          RayKind kind = RayKind::path)
      : plan_(device, {1, 1}),
        stream_{plan_.buffer("count", sizeof(shared::RayCount),
                             storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, gpu::Memory::upload),
                plan_.buffer("rays", capacity * sizeof(shared::Ray), storage, gpu::Memory::upload),
                static_cast<std::uint32_t>(capacity), kind},
        hits_(plan_.buffer("hits", capacity * sizeof(shared::Hit), storage, gpu::Memory::readback)),
        occluded_(plan_.buffer("occluded", capacity * sizeof(std::uint32_t), storage,
                               gpu::Memory::readback)) {
    tracer.trace_closest(plan_, "closest", structure, stream_, hits_);
    tracer.trace_any(plan_, "any", structure, stream_, occluded_);
    plan_.compile();
  }

  /// Traces the first `count` rays and leaves the other results untouched. `blending`: see
  /// shared::RayCount.
  TraceResults run(std::span<const shared::Ray> rays, std::uint32_t count,
                   std::uint32_t blending = 0) {
    TraceResults results{std::vector(rays.size(), shared::Hit{untouched, 0, 0, 0, 0, 0, 0, 0}),
                         std::vector(rays.size(), 7u)};
    const shared::RayCount header = render::kernels::full_count(count, blending);
    std::memcpy(plan_.get(stream_.count).mapped(), &header, sizeof(header));
    std::memcpy(plan_.get(stream_.rays).mapped(), rays.data(), rays.size_bytes());
    const auto hit_bytes = std::as_writable_bytes(std::span(results.hits));
    const auto occluded_bytes = std::as_writable_bytes(std::span(results.occluded));
    std::memcpy(plan_.get(hits_).mapped(), hit_bytes.data(), hit_bytes.size());
    std::memcpy(plan_.get(occluded_).mapped(), occluded_bytes.data(), occluded_bytes.size());
    plan_.execute();
    std::memcpy(hit_bytes.data(), plan_.get(hits_).mapped(), hit_bytes.size());
    std::memcpy(occluded_bytes.data(), plan_.get(occluded_).mapped(), occluded_bytes.size());
    return results;
  }

  TraceResults run(std::span<const shared::Ray> rays) {
    return run(rays, static_cast<std::uint32_t>(rays.size()));
  }

  /// Minimum time of each pass over repeated runs, e.g. "closest 1.2 ms, any 0.8 ms".
  std::string least_times(int repetitions) {
    std::map<std::string, float> least;
    for (int i = 0; i < repetitions; ++i) {
      plan_.execute();
      for (const gpu::PassTiming& pass : plan_.timings()) {
        const auto [known, first] = least.emplace(pass.name, pass.milliseconds);
        if (!first) known->second = std::min(known->second, pass.milliseconds);
      }
    }
    std::string text;
    for (const auto& [name, milliseconds] : least) {
      text += (text.empty() ? "" : ", ") + name + " " + std::to_string(milliseconds) + " ms";
    }
    return text;
  }

 private:
  static constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

  gpu::FramePlan plan_;
  RayStream stream_;
  gpu::BufferRef hits_;
  gpu::BufferRef occluded_;
};

/// A scene with the acceleration structure of one tracer.
class TracedScene {
 public:
  TracedScene(const gpu::Device& device, const RayTracer& tracer, const scene::Scene& scene)
      : device_(device), tracer_(tracer) {
    buffers_.alpha_heap =
        gpu::upload_buffer(device, "alpha masks", std::as_bytes(std::span(scene.alpha_heap)),
                           VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    structure_ = tracer.build(scene, buffers_);
  }

  TraceResults trace(std::span<const shared::Ray> rays, std::uint32_t count,
                     std::uint32_t blending = 0) const {
    return tracing(rays.size()).run(rays, count, blending);
  }

  TraceResults trace(std::span<const shared::Ray> rays, RayKind kind = RayKind::path) const {
    return tracing(rays.size(), kind).run(rays);
  }

  Tracing tracing(std::size_t capacity, RayKind kind = RayKind::path) const {
    return Tracing(device_, tracer_, *structure_, capacity, kind);
  }

  std::unique_ptr<MovingStructure> moving(const scene::Scene& scene) const {
    return tracer_.build_moving(
        structure_, scene,
        {buffers_.vertices, buffers_.indices, buffers_.meshes, buffers_.instances,
         buffers_.materials, buffers_.lights, buffers_.alpha_heap});
  }

 private:
  const gpu::Device& device_;
  const RayTracer& tracer_;
  SceneBuffers buffers_;
  std::shared_ptr<const AccelerationStructure> structure_;
};

inline gpu::DeviceOptions device_options() {
  const char* device = std::getenv("HELIOGRAPH_TEST_DEVICE");
  return {.name_part = device ? device : "", .cache_folder = {}};
}

/// The test device with every tracer that it supports.
struct Rig {
  Rig() {
    for (const protocol::TracerKind kind : supported_tracers(device.report())) {
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
    EXPECT_EQ(rig_->instance.validation_messages(), 0u) << "validation layers reported messages";
  }

  static bool offered(protocol::TracerKind kind) { return rig_->tracers.contains(kind); }
  static std::string unsupported_reason(protocol::TracerKind kind) {
    return rig_->device.report().name + " (" + rig_->device.report().driver +
           ") does not offer the tracer " + std::string(protocol::enum_name(kind));
  }
  static TracedScene traced(const scene::Scene& scene, protocol::TracerKind kind) {
    return {rig_->device, *rig_->tracers.at(kind), scene};
  }

  static inline std::unique_ptr<Rig> rig_;
};

class TracerTest : public TracersTest, public testing::WithParamInterface<protocol::TracerKind> {
 protected:
  void SetUp() override {
    if (offered(GetParam())) return;
    ASSERT_EQ(std::getenv("HELIOGRAPH_TEST_ALL_TRACERS"), nullptr)
        << unsupported_reason(GetParam());
    GTEST_SKIP() << unsupported_reason(GetParam());
  }
};

/// A clip with channels for the instances for which `moves` is true.
template <typename Predicate>
scene::Clip clip_of(const scene::Scene& scene, Predicate moves) {
  scene::Clip clip;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    if (moves(i)) clip.channels.push_back({.node = scene.instances[i].node});
  }
  return clip;
}

/// Fraction of rays with different results.
inline double disagreement(const TraceResults& a, const TraceResults& b) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.hits.size(); ++i) {
    different += !same_hit(a.hits[i], b.hits[i]) || a.occluded[i] != b.occluded[i];
  }
  return static_cast<double>(different) / static_cast<double>(a.hits.size());
}

inline std::size_t hit_count(const TraceResults& results) {
  std::size_t count = 0;
  for (const shared::Hit& hit : results.hits) count += hit.instance != shared::hit_none;
  return count;
}

inline TraceResults brute_force(const scene::Scene& scene, std::span<const shared::Ray> rays) {
  TraceResults results;
  for (const shared::Ray& ray : rays) {
    results.hits.push_back(closest_hit_brute_force(scene, ray));
    results.occluded.push_back(results.hits.back().instance != shared::hit_none ? 1 : 0);
  }
  return results;
}

inline std::string test_name(const testing::TestParamInfo<protocol::TracerKind>& test) {
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
}

}  // namespace heliograph::tracing
