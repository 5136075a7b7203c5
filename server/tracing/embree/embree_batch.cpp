#include "tracing/embree/embree_batch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "tracing/bvh/alpha_mask.hpp"

namespace heliograph::tracing {
namespace {

// An empty interval: Embree ignores such rays.
constexpr float dead_from = 1.0f;
constexpr float dead_to = 0.0f;

struct Interval {
  float from = dead_from;
  float to = dead_to;
};

// The tracers exclude both ends. Embree's robust mode includes them, its fast mode excludes the
// first. `t_min` >= 0, `t_max` > 0. Embree flushes denormals to zero.
Interval interval_between(float t_min, float t_max, bool robust) {
  if (!(t_min < t_max)) return {};
  const float after = std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_min) + 1);
  const float before = std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_max) - 1);
  return {robust ? std::max(after, std::numeric_limits<float>::min()) : t_min, before};
}

shared::Hit miss(const shared::Ray& ray) {
  return {ray.t_max, shared::hit_none, 0, 0.0f, 0.0f, 0, 0, 0};
}

/// `placed`: the instance that was hit, invalid for triangles of the flat scene.
shared::Hit make_hit(float t, unsigned placed, unsigned geometry, unsigned triangle, float u,
                     float v) {
  const unsigned instance = placed == RTC_INVALID_GEOMETRY_ID ? geometry : placed;
  return {t, instance, triangle, u, v, 0, 0, 0};
}

constexpr std::size_t packet = 16;  // the most that Embree takes

/// A packet of rays; those that are not valid are not traced.
struct Lanes {
  alignas(64) std::array<int, packet> valid{};
  alignas(64) RTCRayHit16 rays{};

  /// No ray is valid. Where packets of Embree have fewer lanes it goes by the intervals alone.
  void clear() {
    valid.fill(0);
    std::fill_n(rays.ray.tnear, packet, dead_from);
    std::fill_n(rays.ray.tfar, packet, dead_to);
  }

  void set(std::size_t lane, const shared::Ray& from, std::uint32_t blending,
           const Interval& interval) {
    RTCRay16& to = rays.ray;
    valid[lane] = interval.from <= interval.to ? -1 : 0;
    to.org_x[lane] = from.origin.x;
    to.org_y[lane] = from.origin.y;
    to.org_z[lane] = from.origin.z;
    to.tnear[lane] = interval.from;
    to.dir_x[lane] = from.direction.x;
    to.dir_y[lane] = from.direction.y;
    to.dir_z[lane] = from.direction.z;
    to.time[lane] = 0.0f;
    to.tfar[lane] = interval.to;
    to.mask[lane] = ~0u;
    to.id[lane] = ray_blending(from, blending);  // read by filter functions
    to.flags[lane] = 0;
  }
};

#if RTC_VERSION_MAJOR < 4

RTCIntersectContext make_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

void intersect_lanes(RTCScene scene, Lanes& lanes) {
  RTCIntersectContext context = make_context(false);
  rtcIntersect16(lanes.valid.data(), scene, &context, &lanes.rays);
}

void occluded_lanes(RTCScene scene, Lanes& lanes) {
  RTCIntersectContext context = make_context(false);
  rtcOccluded16(lanes.valid.data(), scene, &context, &lanes.rays.ray);
}

#else

void intersect_lanes(RTCScene scene, Lanes& lanes) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
  rtcIntersect16(lanes.valid.data(), scene, &lanes.rays, &arguments);
}

void occluded_lanes(RTCScene scene, Lanes& lanes) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
  rtcOccluded16(lanes.valid.data(), scene, &lanes.rays.ray, &arguments);
}

#endif

/// Replaces those of `hits` that are behind others in this scene.
void intersect_packets(const EmbreeTarget& target, const RayBatch& batch, shared::Hit* hits) {
  Lanes lanes;
  const auto& hit = lanes.rays.hit;
  for (std::size_t first = 0; first < batch.rays.size(); first += packet) {
    const auto some = batch.rays.subspan(first, std::min(packet, batch.rays.size() - first));
    lanes.clear();
    for (std::size_t i = 0; i < some.size(); ++i) {
      lanes.set(i, some[i], batch.blending,
                interval_between(some[i].t_min, hits[first + i].t, target.robust));
    }
    std::fill_n(lanes.rays.hit.geomID, packet, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(lanes.rays.hit.instID[0], packet, RTC_INVALID_GEOMETRY_ID);
    intersect_lanes(target.scene, lanes);
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hits[first + i] = make_hit(lanes.rays.ray.tfar[i], hit.instID[0][i], hit.geomID[i],
                                 hit.primID[i], hit.u[i], hit.v[i]);
    }
  }
}

/// Sets `occluded` of the rays with a hit, among those where it is 0.
void occluded_packets(const EmbreeTarget& target, const RayBatch& batch, std::uint32_t* occluded) {
  Lanes lanes;
  std::array<std::size_t, packet> asked;
  for (std::size_t next = 0; next < batch.rays.size();) {
    lanes.clear();
    std::size_t used = 0;
    for (; used < packet && next < batch.rays.size(); ++next) {
      if (occluded[next]) continue;
      asked[used] = next;
      const shared::Ray& ray = batch.rays[next];
      lanes.set(used++, ray, batch.blending, interval_between(ray.t_min, ray.t_max, target.robust));
    }
    occluded_lanes(target.scene, lanes);
    // Embree sets tfar to -infinity for hits.
    for (std::size_t i = 0; i < used; ++i) {
      occluded[asked[i]] = lanes.rays.ray.tfar[i] < dead_to ? 1 : 0;
    }
  }
}

#if RTC_VERSION_MAJOR < 4

// Embree 3 has streams besides. Those of any-hit queries, which it sorts by direction, are 1.2 to
// 1.6 times as fast as packets among triangles, but take twice as long among instances. Those of
// closest-hit queries are packets, unless they are coherent: then they take half the time. In
// scenes of instances coherent streams may not return at all, for rays along an axis.

// Written in place: a copy would wait for the stores of single floats.
void write_ray(RTCRay& to, const shared::Ray& from, std::uint32_t blending, bool robust) {
  const Interval interval = interval_between(from.t_min, from.t_max, robust);
  to.org_x = from.origin.x;
  to.org_y = from.origin.y;
  to.org_z = from.origin.z;
  to.tnear = interval.from;
  to.dir_x = from.direction.x;
  to.dir_y = from.direction.y;
  to.dir_z = from.direction.z;
  to.time = 0.0f;
  to.tfar = interval.to;
  to.mask = ~0u;
  to.id = ray_blending(from, blending);
  to.flags = 0;
}

/// Of flat scenes only. Writes misses, too.
void intersect_coherent_stream(const EmbreeTarget& target, const RayBatch& batch,
                               shared::Hit* hits) {
  std::array<RTCRayHit, embree_batch> rays;
  const auto count = static_cast<unsigned>(batch.rays.size());
  for (std::size_t i = 0; i < count; ++i) {
    write_ray(rays[i].ray, batch.rays[i], batch.blending, target.robust);
    rays[i].hit.geomID = rays[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context = make_context(true);
  rtcIntersect1M(target.scene, &context, rays.data(), count, sizeof(RTCRayHit));
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [ray, hit] = rays[i];
    hits[i] = hit.geomID == RTC_INVALID_GEOMETRY_ID
                  ? miss(batch.rays[i])
                  : make_hit(ray.tfar, hit.instID[0], hit.geomID, hit.primID, hit.u, hit.v);
  }
}

void occluded_stream(const EmbreeTarget& target, const RayBatch& batch, std::uint32_t* occluded) {
  std::array<RTCRay, embree_batch> rays;
  const auto count = static_cast<unsigned>(batch.rays.size());
  for (std::size_t i = 0; i < count; ++i) {
    write_ray(rays[i], batch.rays[i], batch.blending, target.robust);
  }
  RTCIntersectContext context = make_context(false);
  rtcOccluded1M(target.scene, &context, rays.data(), count, sizeof(RTCRay));
  for (std::size_t i = 0; i < count; ++i) occluded[i] = rays[i].tfar < dead_to ? 1 : 0;
}

#else

// Embree 4 has packets only.

void intersect_coherent_stream(const EmbreeTarget& target, const RayBatch& batch,
                               shared::Hit* hits) {
  std::ranges::transform(batch.rays, hits, miss);
  intersect_packets(target, batch, hits);
}

void occluded_stream(const EmbreeTarget& target, const RayBatch& batch, std::uint32_t* occluded) {
  occluded_packets(target, batch, occluded);
}

#endif

}  // namespace

void intersect_batch(const EmbreeScenes& scenes, const RayBatch& batch, shared::Hit* hits) {
  if (scenes.flat.scene && batch.coherent) {
    intersect_coherent_stream(scenes.flat, batch, hits);
  } else {
    std::ranges::transform(batch.rays, hits, miss);
    if (scenes.flat.scene) intersect_packets(scenes.flat, batch, hits);
  }
  if (scenes.instanced.scene) intersect_packets(scenes.instanced, batch, hits);
}

void occluded_batch(const EmbreeScenes& scenes, const RayBatch& batch, std::uint32_t* occluded) {
  std::fill_n(occluded, batch.rays.size(), 0u);
  if (scenes.flat.scene) occluded_stream(scenes.flat, batch, occluded);
  if (scenes.instanced.scene) occluded_packets(scenes.instanced, batch, occluded);
}

}  // namespace heliograph::tracing
