#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "tracing/ray_tracer.hpp"

namespace heliograph::bench {

/// A tracer that remembers which streams it was asked to trace, so that others may trace them too.
class RecordingTracer : public tracing::RayTracer {
 public:
  struct Stream {
    const gpu::FramePlan* plan;
    tracing::RayStream rays;
    bool any;
  };

  explicit RecordingTracer(std::unique_ptr<tracing::RayTracer> tracer)
      : tracer_(std::move(tracer)) {}

  /// The stream of the pass `name` in the plan declared last, unless other passes trace the same
  /// memory: it no longer holds the rays then.
  const Stream* find(const std::string& name) const;

  protocol::TracerKind kind() const override { return tracer_->kind(); }
  std::shared_ptr<const tracing::AccelerationStructure> build(
      const scene::Scene& scene, const tracing::SceneBuffers& buffers) const override;
  std::unique_ptr<tracing::MovingStructure> build_moving(
      std::shared_ptr<const tracing::AccelerationStructure> rest, const scene::Scene& scene,
      const tracing::SceneTables& tables) const override;
  void trace_closest(gpu::FramePlan& plan, const std::string& name,
                     const tracing::AccelerationStructure& structure,
                     const tracing::RayStream& rays, gpu::BufferRef hits) const override;
  void trace_any(gpu::FramePlan& plan, const std::string& name,
                 const tracing::AccelerationStructure& structure, const tracing::RayStream& rays,
                 gpu::BufferRef occluded) const override;

 private:
  std::unique_ptr<tracing::RayTracer> tracer_;
  mutable std::map<std::string, Stream> streams_;
};

/// Embree alone, on rays that lie ready in its own layout, with nothing done about what it finds:
/// what a tracer can at best come up to.
class EmbreeAlone {
 public:
  /// `scene` at rest, and outliving this.
  explicit EmbreeAlone(const scene::Scene& scene);
  ~EmbreeAlone();
  EmbreeAlone(const EmbreeAlone&) = delete;
  EmbreeAlone& operator=(const EmbreeAlone&) = delete;

  /// Milliseconds for the rays that the stream holds now, the median of several runs on all
  /// processors; nothing where its memory is not mapped.
  std::optional<double> milliseconds(const RecordingTracer::Stream& stream) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::bench
