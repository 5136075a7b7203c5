#pragma once

#include <memory>
#include <stop_token>
#include <type_traits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace heliograph::tracing {

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
  void operator()(RTCBuffer buffer) const { rtcReleaseBuffer(buffer); }
  void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};

/// Owns one reference to an Embree object: EmbreeHandle<RTCScene>.
template <typename Handle>
using EmbreeHandle = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeRelease>;

/// @throws std::runtime_error when Embree does not support this CPU
EmbreeHandle<RTCDevice> make_embree_device();

/// @throws std::runtime_error naming `action` when a call on this thread failed since the last
/// check
void check_embree(RTCDevice device, const char* action);

/// Builds a scene. @throws std::runtime_error naming `action`; scene::LoadCancelled soon after
/// `stop` was requested
void commit_scene(RTCDevice device, RTCScene scene, const char* action,
                  const std::stop_token& stop);

}  // namespace heliograph::tracing
