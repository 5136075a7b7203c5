#pragma once

#include <memory>
#include <stop_token>

#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// A tracer whose builds can be stopped. Those of the driver cannot.
class StoppableTracer : public RayTracer {
 public:
  /// Thread safe. @throws scene::LoadCancelled soon after `stop` was requested
  virtual std::shared_ptr<const AccelerationStructure> build_unless_stopped(
      const scene::Scene& scene, const SceneBuffers& buffers,
      const std::stop_token& stop) const = 0;

  std::shared_ptr<const AccelerationStructure> build(const scene::Scene& scene,
                                                     const SceneBuffers& buffers) const override {
    return build_unless_stopped(scene, buffers, {});
  }
};

}  // namespace heliograph::tracing
