#include "tests/bench/embree_rate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <vector>

#include "shaders/shared/ray.h"
#include "tracing/embree/embree_batch.hpp"
#include "tracing/embree/embree_scene.hpp"

namespace heliograph::bench {
namespace {

constexpr int runs = 5;

bool alive(const shared::Ray& ray) {
  return ray.t_min < ray.t_max;
}

#if RTC_VERSION_MAJOR < 4

using Prepared = std::vector<RTCRayHit>;

Prepared prepare(std::span<const shared::Ray> rays) {
  Prepared all;
  for (const shared::Ray& ray : rays) {
    if (!alive(ray)) continue;
    RTCRayHit one{};
    one.ray = {ray.origin.x,
               ray.origin.y,
               ray.origin.z,
               ray.t_min,
               ray.direction.x,
               ray.direction.y,
               ray.direction.z,
               0.0f,
               ray.t_max,
               ~0u,
               0u,
               0u};
    one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    all.push_back(one);
  }
  return all;
}

void trace(RTCScene scene, Prepared& rays, bool any) {
  const std::size_t batches = (rays.size() + tracing::embree_batch - 1) / tracing::embree_batch;
  tbb::parallel_for(std::size_t(0), batches, [&](std::size_t batch) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    const std::size_t first = batch * tracing::embree_batch;
    const auto count = static_cast<unsigned>(std::min(tracing::embree_batch, rays.size() - first));
    if (any) {
      rtcOccluded1M(scene, &context, &rays[first].ray, count, sizeof(RTCRayHit));
    } else {
      rtcIntersect1M(scene, &context, &rays[first], count, sizeof(RTCRayHit));
    }
  });
}

#else

constexpr std::size_t lanes = 16;

struct alignas(64) Packet {
  std::array<int, lanes> valid;
  RTCRayHit16 rays;
};

using Prepared = std::vector<Packet>;

Prepared prepare(std::span<const shared::Ray> rays) {
  Prepared all;
  std::size_t lane = lanes;
  for (const shared::Ray& ray : rays) {
    if (!alive(ray)) continue;
    if (lane == lanes) {
      all.emplace_back();
      all.back().valid.fill(0);
      lane = 0;
    }
    Packet& packet = all.back();
    RTCRay16& to = packet.rays.ray;
    packet.valid[lane] = -1;
    to.org_x[lane] = ray.origin.x;
    to.org_y[lane] = ray.origin.y;
    to.org_z[lane] = ray.origin.z;
    to.dir_x[lane] = ray.direction.x;
    to.dir_y[lane] = ray.direction.y;
    to.dir_z[lane] = ray.direction.z;
    to.tnear[lane] = ray.t_min;
    to.tfar[lane] = ray.t_max;
    to.mask[lane] = ~0u;
    packet.rays.hit.geomID[lane] = packet.rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    ++lane;
  }
  return all;
}

void trace(RTCScene scene, Prepared& packets, bool any) {
  constexpr std::size_t packets_of_batch = tracing::embree_batch / lanes;
  const std::size_t batches = (packets.size() + packets_of_batch - 1) / packets_of_batch;
  tbb::parallel_for(std::size_t(0), batches, [&](std::size_t batch) {
    RTCIntersectArguments closest;
    rtcInitIntersectArguments(&closest);
    closest.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    RTCOccludedArguments occluded;
    rtcInitOccludedArguments(&occluded);
    occluded.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    const std::size_t first = batch * packets_of_batch;
    const std::size_t end = std::min(first + packets_of_batch, packets.size());
    for (std::size_t i = first; i < end; ++i) {
      Packet& packet = packets[i];
      if (any) {
        rtcOccluded16(packet.valid.data(), scene, &packet.rays.ray, &occluded);
      } else {
        rtcIntersect16(packet.valid.data(), scene, &packet.rays, &closest);
      }
    }
  });
}

#endif

}  // namespace

const RecordingTracer::Stream* RecordingTracer::find(const std::string& name) const {
  const auto found = streams_.find(name);
  if (found == streams_.end()) return nullptr;
  const auto users = std::count_if(streams_.begin(), streams_.end(), [&](const auto& other) {
    return other.second.rays.rays.index == found->second.rays.rays.index;
  });
  return users == 1 ? &found->second : nullptr;
}

std::shared_ptr<const tracing::AccelerationStructure> RecordingTracer::build(
    const scene::Scene& scene, const tracing::SceneBuffers& buffers) const {
  return tracer_->build(scene, buffers);
}

std::unique_ptr<tracing::MovingStructure> RecordingTracer::build_moving(
    std::shared_ptr<const tracing::AccelerationStructure> rest, const scene::Scene& scene,
    const tracing::SceneTables& tables) const {
  return tracer_->build_moving(std::move(rest), scene, tables);
}

void RecordingTracer::trace_closest(gpu::FramePlan& plan, const std::string& name,
                                    const tracing::AccelerationStructure& structure,
                                    const tracing::RayStream& rays, gpu::BufferRef hits) const {
  streams_[name] = {&plan, rays, false};
  tracer_->trace_closest(plan, name, structure, rays, hits);
}

void RecordingTracer::trace_any(gpu::FramePlan& plan, const std::string& name,
                                const tracing::AccelerationStructure& structure,
                                const tracing::RayStream& rays, gpu::BufferRef occluded) const {
  streams_[name] = {&plan, rays, true};
  tracer_->trace_any(plan, name, structure, rays, occluded);
}

struct EmbreeAlone::State {
  explicit State(const scene::Scene& rest)
      : device(tracing::make_embree_device()),
        scene(device.get(), rest,
              tracing::make_embree_meshes(device.get(), rest, rest.alpha_heap)) {}

  tracing::EmbreeHandle<RTCDevice> device;
  tracing::EmbreeScene scene;
};

EmbreeAlone::EmbreeAlone(const scene::Scene& scene) : state_(std::make_unique<State>(scene)) {}
EmbreeAlone::~EmbreeAlone() = default;

std::optional<double> EmbreeAlone::milliseconds(const RecordingTracer::Stream& stream) const {
  const std::byte* const count = stream.plan->get(stream.rays.count).mapped();
  const std::byte* const rays = stream.plan->get(stream.rays.rays).mapped();
  if (!count || !rays) return std::nullopt;
  const auto counted = reinterpret_cast<const shared::RayCount*>(count)->count;
  const Prepared ready = prepare(
      {reinterpret_cast<const shared::Ray*>(rays), std::min(counted, stream.rays.capacity)});
  std::array<double, runs> times{};
  for (double& time : times) {
    Prepared work = ready;
    const auto start = std::chrono::steady_clock::now();
    trace(state_->scene.handle(), work, stream.any);
    time =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  std::nth_element(times.begin(), times.begin() + runs / 2, times.end());
  return times[runs / 2];
}

}  // namespace heliograph::bench
