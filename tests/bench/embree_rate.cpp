#include "tests/bench/embree_rate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <vector>

#include "shaders/shared/ray.h"
#include "tracing/embree/embree_scene.hpp"

namespace heliograph::bench {
namespace {

/// How a stream is traced in a scene.
struct Calls {
  bool coherent = false;
  std::size_t rays = 1024;  // per call
};

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

void trace(RTCScene scene, Prepared& rays, bool any, const Calls& calls) {
  const std::size_t batches = (rays.size() + calls.rays - 1) / calls.rays;
  tbb::parallel_for(std::size_t(0), batches, [&](std::size_t batch) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = calls.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                   : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    const std::size_t first = batch * calls.rays;
    const auto count = static_cast<unsigned>(std::min(calls.rays, rays.size() - first));
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

void trace(RTCScene scene, Prepared& packets, bool any, const Calls& calls) {
  const std::size_t packets_of_batch = calls.rays / lanes;
  const RTCRayQueryFlags flags =
      calls.coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  const std::size_t batches = (packets.size() + packets_of_batch - 1) / packets_of_batch;
  tbb::parallel_for(std::size_t(0), batches, [&](std::size_t batch) {
    RTCIntersectArguments closest;
    rtcInitIntersectArguments(&closest);
    closest.flags = flags;
    RTCOccludedArguments occluded;
    rtcInitOccludedArguments(&occluded);
    occluded.flags = flags;
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

std::string describe(const tracing::EmbreeLayout& layout, const Calls& calls) {
  std::string text = layout.flat ? "flat" : "instanced";
  text += layout.build.robust ? ", robust" : ", fast";
  text += layout.build.quality == RTC_BUILD_QUALITY_HIGH ? ", high quality" : ", medium quality";
  if (calls.coherent) text += ", coherent";
  return text + ", " + std::to_string(calls.rays) + " rays";
}

}  // namespace

const RecordingTracer::Stream* RecordingTracer::find(const std::string& name) const {
  const auto found = streams_.find(name);
  return found == streams_.end() ? nullptr : &found->second;
}

void RecordingTracer::record(gpu::FramePlan& plan, const std::string& name,
                             const tracing::RayStream& rays, bool any) const {
  // Other tracers' rays need not be in mapped memory.
  if (kind() != protocol::TracerKind::embree) return;
  plan.host(name + std::string(pass_suffix),
            [this, &plan, name, rays, any] {
              const auto& header =
                  *reinterpret_cast<const shared::RayCount*>(plan.get(rays.count).mapped());
              const auto* const first =
                  reinterpret_cast<const shared::Ray*>(plan.get(rays.rays).mapped());
              const std::size_t count = std::min(header.count, rays.capacity);
              Stream& stream = streams_[name];
              stream.any = any;
              stream.rays.insert(stream.rays.end(), first, first + count);
            })
      .read(rays.count)
      .read(rays.rays)
      .when([this] { return recording_; });
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
  record(plan, name, rays, false);
  tracer_->trace_closest(plan, name, structure, rays, hits);
}

void RecordingTracer::trace_any(gpu::FramePlan& plan, const std::string& name,
                                const tracing::AccelerationStructure& structure,
                                const tracing::RayStream& rays, gpu::BufferRef occluded) const {
  record(plan, name, rays, true);
  tracer_->trace_any(plan, name, structure, rays, occluded);
}

struct EmbreeAlone::State {
  struct Built {
    tracing::EmbreeLayout layout;
    tracing::EmbreeScene scene;
  };

  explicit State(const scene::Scene& rest) : device(tracing::make_embree_device()) {
    // Robust scenes of high quality are built in medium quality.
    for (const bool flat : {false, true}) {
      for (const tracing::EmbreeBuild build : {tracing::EmbreeBuild{true, RTC_BUILD_QUALITY_MEDIUM},
                                               {false, RTC_BUILD_QUALITY_MEDIUM},
                                               {false, RTC_BUILD_QUALITY_HIGH}}) {
        const tracing::EmbreeLayout layout{.flat = flat, .build = build, .fast_copy = false};
        built.push_back({layout, {device.get(), rest, rest.alpha_heap, layout}});
      }
    }
  }

  tracing::EmbreeHandle<RTCDevice> device;
  std::vector<Built> built;
};

EmbreeAlone::EmbreeAlone(const scene::Scene& scene) : state_(std::make_unique<State>(scene)) {}
EmbreeAlone::~EmbreeAlone() = default;

std::optional<EmbreeAlone::Fastest> EmbreeAlone::fastest(
    const RecordingTracer::Stream& stream) const {
  const Prepared ready = prepare(stream.rays);
  if (ready.empty()) return std::nullopt;

  const auto median_of = [&](const State::Built& built, const Calls& calls, std::size_t runs) {
    const auto [flat, instanced] = built.scene.scenes(tracing::RayKind::path);
    std::vector<double> times(runs);
    for (double& time : times) {
      Prepared work = ready;
      const auto start = std::chrono::steady_clock::now();
      if (flat.scene) trace(flat.scene, work, stream.any, calls);
      if (instanced.scene) trace(instanced.scene, work, stream.any, {false, calls.rays});
      time = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                 .count();
    }
    std::ranges::nth_element(times, times.begin() + static_cast<std::ptrdiff_t>(runs / 2));
    return times[runs / 2];
  };
  struct Way {
    double milliseconds;
    const State::Built* built;
    Calls calls;
  };
  std::vector<Way> ways;
  for (const State::Built& built : state_->built) {
    for (const bool coherent : {false, true}) {
      if (coherent && !built.layout.flat) continue;
      const Calls calls{coherent};
      ways.push_back({median_of(built, calls, 3), &built, calls});
    }
  }
  // The number of rays per call matters less than the rest.
  constexpr std::size_t tried = 3;
  std::ranges::partial_sort(ways, ways.begin() + tried, {}, &Way::milliseconds);
  Way best = ways.front();
  for (const Way& way : std::span(ways).first(tried)) {
    for (const std::size_t rays_per_call : {256, 1024, 4096}) {
      const Calls calls{way.calls.coherent, rays_per_call};
      const double time = median_of(*way.built, calls, 5);
      if (time < best.milliseconds) best = {time, way.built, calls};
    }
  }
  return Fastest{best.milliseconds, describe(best.built->layout, best.calls)};
}

}  // namespace heliograph::bench
