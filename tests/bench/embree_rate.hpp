#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shaders/shared/ray.h"
#include "tracing/ray_tracer.hpp"

namespace heliograph::bench {

/// A tracer that also keeps the rays of a frame, so that other tracers can be timed on them.
class RecordingTracer : public tracing::RayTracer {
 public:
  /// Ends the names of the passes that keep rays, beside those of the tracer.
  static constexpr std::string_view pass_suffix = ".recording";

  struct Stream {
    std::vector<shared::Ray> rays;
    bool any = false;
  };

  explicit RecordingTracer(std::unique_ptr<tracing::RayTracer> tracer)
      : tracer_(std::move(tracer)) {}

  /// Whether frames keep their rays from now on, which takes time.
  void set_recording(bool recording) {
    recording_ = recording;
    if (recording) streams_.clear();
  }
  /// The rays that the passes `name` traced in the recorded frames. Null without any.
  const Stream* find(const std::string& name) const;

  protocol::TracerKind kind() const override { return tracer_->kind(); }
  std::shared_ptr<const tracing::AccelerationStructure> build(
      const scene::Scene& scene, const tracing::SceneBuffers& buffers) const override;
  std::shared_ptr<const tracing::AccelerationStructure> build_apart(
      const scene::Scene& scene, const tracing::SceneBuffers& buffers) const override {
    return tracer_->build_apart(scene, buffers);
  }
  std::shared_ptr<const tracing::AccelerationStructure> build_without(
      const std::vector<bool>& hidden, std::shared_ptr<const tracing::AccelerationStructure> rest,
      const scene::Scene& scene, const tracing::SceneBuffers& buffers) const override {
    return tracer_->build_without(hidden, std::move(rest), scene, buffers);
  }
  std::unique_ptr<tracing::MovingStructure> build_moving(
      std::shared_ptr<const tracing::AccelerationStructure> rest, const scene::Scene& scene,
      const tracing::SceneTables& tables) const override;
  void trace_closest(gpu::FramePlan& plan, const std::string& name,
                     const tracing::AccelerationStructure& structure,
                     const tracing::RayStream& rays, gpu::BufferRef hits) const override;
  void trace_any(gpu::FramePlan& plan, const std::string& name,
                 const tracing::AccelerationStructure& structure, const tracing::RayStream& rays,
                 gpu::BufferRef occluded) const override;
  std::optional<tracing::WalkedHierarchy> walked(
      const tracing::AccelerationStructure& structure) const override {
    return tracer_->walked(structure);
  }

 private:
  void record(gpu::FramePlan& plan, const std::string& name, const tracing::RayStream& rays,
              bool any) const;

  std::unique_ptr<tracing::RayTracer> tracer_;
  bool recording_ = false;
  mutable std::map<std::string, Stream> streams_;
};

/// Embree alone on rays in its own layout, without use of the results: the upper bound for a
/// tracer. Every way to build a scene and to trace a stream is tried: instances or triangles in
/// world space, robust or fast, medium or high quality, coherent or not, rays per call.
class EmbreeAlone {
 public:
  struct Fastest {
    double milliseconds;  // median of several runs on all cores
    std::string way;      // such as "flat, fast, high quality, coherent, 1024 rays"
  };

  /// `scene` in its default pose; outlives this object.
  explicit EmbreeAlone(const scene::Scene& scene);
  ~EmbreeAlone();
  EmbreeAlone(const EmbreeAlone&) = delete;
  EmbreeAlone& operator=(const EmbreeAlone&) = delete;

  /// Nullopt for a stream without rays.
  std::optional<Fastest> fastest(const RecordingTracer::Stream& stream) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::bench
