#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "tracing/ray_tracer.hpp"

namespace heliograph::bench {

/// A tracer that records the ray streams it traces, so that other tracers can be timed on them.
class RecordingTracer : public tracing::RayTracer {
 public:
  struct Stream {
    const gpu::FramePlan* plan;
    tracing::RayStream rays;
    bool any;
  };

  explicit RecordingTracer(std::unique_ptr<tracing::RayTracer> tracer)
      : tracer_(std::move(tracer)) {}

  /// The stream of the pass `name` in the last declared plan, unless later passes overwrite its
  /// memory.
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

/// Embree alone on rays in its own layout, without use of the results: the upper bound for a
/// tracer.
class EmbreeAlone {
 public:
  /// `scene` in its default pose; outlives this object.
  explicit EmbreeAlone(const scene::Scene& scene);
  ~EmbreeAlone();
  EmbreeAlone(const EmbreeAlone&) = delete;
  EmbreeAlone& operator=(const EmbreeAlone&) = delete;

  /// Milliseconds for the stream's current rays, median of several runs on all cores; nullopt where
  /// its memory is not mapped.
  std::optional<double> milliseconds(const RecordingTracer::Stream& stream) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::bench
