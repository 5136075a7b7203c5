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

// Embree's robust mode includes hits at both ends, the tracers exclude them. `t_min` >= 0,
// `t_max` > 0. Embree flushes denormals to zero.
float first_after(float t_min) {
  const float next = std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_min) + 1);
  return std::max(next, std::numeric_limits<float>::min());
}

float last_before(float t_max) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(t_max) - 1);
}

shared::Hit make_hit(float t, unsigned instance, unsigned triangle, float u, float v) {
  return {t, instance, triangle, u, v, 0, 0, 0};
}

shared::Hit miss(const shared::Ray& ray) {
  return make_hit(ray.t_max, shared::hit_none, 0, 0.0f, 0.0f);
}

#if RTC_VERSION_MAJOR < 4

// Embree 3: ray streams, which it sorts by direction. 395k shadow rays of an atrium take 12.5 ms as
// streams and 52 ms one by one.

RTCIntersectContext incoherent() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

RTCRay to_embree(const shared::Ray& ray, std::uint32_t blending) {
  const bool alive = ray.t_min < ray.t_max;
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.tnear = alive ? first_after(ray.t_min) : dead_from;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = alive ? last_before(ray.t_max) : dead_to;
  result.mask = ~0u;
  result.id = ray_blending(ray, blending);  // read by filter functions
  return result;
}

}  // namespace

void intersect_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                     shared::Hit* hits) {
  RTCIntersectContext context = incoherent();
  std::array<RTCRayHit, embree_batch> batch;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    batch[i].ray = to_embree(rays[i], blending);
    batch[i].hit.geomID = batch[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect1M(scene, &context, batch.data(), static_cast<unsigned>(rays.size()),
                 sizeof(RTCRayHit));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [ray, hit] = batch[i];
    hits[i] = hit.geomID == RTC_INVALID_GEOMETRY_ID
                  ? miss(rays[i])
                  : make_hit(ray.tfar, hit.instID[0], hit.primID, hit.u, hit.v);
  }
}

void occluded_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                    std::uint32_t* occluded) {
  RTCIntersectContext context = incoherent();
  std::array<RTCRay, embree_batch> batch;
  for (std::size_t i = 0; i < rays.size(); ++i) batch[i] = to_embree(rays[i], blending);
  rtcOccluded1M(scene, &context, batch.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRay));
  // Embree sets tfar to -infinity for hits.
  for (std::size_t i = 0; i < rays.size(); ++i) occluded[i] = batch[i].tfar < dead_to ? 1 : 0;
}

#else

// Embree 4 has no streams: packets of 16, the maximum.

constexpr std::size_t packet = 16;

struct Lanes {
  alignas(64) std::array<int, packet> valid{};
};

Lanes load(std::span<const shared::Ray> rays, std::uint32_t blending, RTCRay16& lanes) {
  Lanes result;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const shared::Ray& ray = rays[i];
    result.valid[i] = ray.t_min < ray.t_max ? -1 : 0;
    lanes.org_x[i] = ray.origin.x;
    lanes.org_y[i] = ray.origin.y;
    lanes.org_z[i] = ray.origin.z;
    lanes.tnear[i] = result.valid[i] ? first_after(ray.t_min) : dead_from;
    lanes.dir_x[i] = ray.direction.x;
    lanes.dir_y[i] = ray.direction.y;
    lanes.dir_z[i] = ray.direction.z;
    lanes.time[i] = 0.0f;
    lanes.tfar[i] = result.valid[i] ? last_before(ray.t_max) : dead_to;
    lanes.mask[i] = ~0u;
    lanes.id[i] = ray_blending(ray, blending);  // read by filter functions
    lanes.flags[i] = 0;
  }
  return result;
}

}  // namespace

void intersect_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                     shared::Hit* hits) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
  for (std::size_t first = 0; first < rays.size(); first += packet) {
    const auto some = rays.subspan(first, std::min(packet, rays.size() - first));
    RTCRayHit16 lanes{};
    const Lanes active = load(some, blending, lanes.ray);
    std::fill_n(lanes.hit.geomID, packet, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(lanes.hit.instID[0], packet, RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(active.valid.data(), scene, &lanes, &arguments);
    for (std::size_t i = 0; i < some.size(); ++i) {
      hits[first + i] = lanes.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
                            ? miss(some[i])
                            : make_hit(lanes.ray.tfar[i], lanes.hit.instID[0][i],
                                       lanes.hit.primID[i], lanes.hit.u[i], lanes.hit.v[i]);
    }
  }
}

void occluded_batch(RTCScene scene, std::span<const shared::Ray> rays, std::uint32_t blending,
                    std::uint32_t* occluded) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
  for (std::size_t first = 0; first < rays.size(); first += packet) {
    const auto some = rays.subspan(first, std::min(packet, rays.size() - first));
    RTCRay16 lanes{};
    const Lanes active = load(some, blending, lanes);
    rtcOccluded16(active.valid.data(), scene, &lanes, &arguments);
    for (std::size_t i = 0; i < some.size(); ++i) {
      occluded[first + i] = lanes.tfar[i] < dead_to ? 1 : 0;
    }
  }
}

#endif

}  // namespace heliograph::tracing
