#include "tracing/embree/embree.hpp"

#include <stdexcept>
#include <string>

#include "scene/import_error.hpp"

namespace heliograph::tracing {
namespace {

const char* error_name(RTCError error) {
  switch (error) {
    case RTC_ERROR_NONE:
      return "no error";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported processor";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

bool commit_goes_on(void* stop, double) {
  return !static_cast<const std::stop_token*>(stop)->stop_requested();
}

}  // namespace

EmbreeHandle<RTCDevice> make_embree_device() {
  EmbreeHandle<RTCDevice> device(rtcNewDevice(nullptr));
  check_embree(device.get(), "start");
  return device;
}

void check_embree(RTCDevice device, const char* action) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw std::runtime_error("Embree could not " + std::string(action) + ": " + error_name(error));
}

void commit_scene(RTCDevice device, RTCScene scene, const char* action,
                  const std::stop_token& stop) {
  std::stop_token asked = stop;
  rtcSetSceneProgressMonitorFunction(scene, commit_goes_on, &asked);
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  if (stop.stop_requested()) {
    rtcGetDeviceError(device);  // that it was cancelled
    throw scene::LoadCancelled();
  }
  check_embree(device, action);
}

}  // namespace heliograph::tracing
