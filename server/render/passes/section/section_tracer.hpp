#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/api/section.hpp"
#include "render/resources/programs.hpp"
#include "shaders/shared/section.h"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// @throws std::invalid_argument for more than shared::most_section_planes
shared::SectionConstants section_constants(const Section& section);

/// A tracer that cuts the interval of every ray to what the planes leave of it, in a pass of its
/// own before the tracer's: shadows, reflections and paths need to know nothing of planes. A ray
/// cut to nothing misses.
class SectionTracer : public tracing::RayTracer {
 public:
  /// All outlive this and its plans; `section` is read in every frame.
  SectionTracer(const tracing::RayTracer& tracer, const Programs& programs, const Section& section)
      : tracer_(tracer), programs_(programs), section_(section) {}

  protocol::TracerKind kind() const override { return tracer_.kind(); }
  std::shared_ptr<const tracing::AccelerationStructure> build(
      const scene::Scene& scene, const tracing::SceneBuffers& buffers) const override {
    return tracer_.build(scene, buffers);
  }
  std::shared_ptr<const tracing::AccelerationStructure> build_apart(
      const scene::Scene& scene, const tracing::SceneBuffers& buffers) const override {
    return tracer_.build_apart(scene, buffers);
  }
  std::shared_ptr<const tracing::AccelerationStructure> build_without(
      const std::vector<bool>& hidden, std::shared_ptr<const tracing::AccelerationStructure> rest,
      const scene::Scene& scene, const tracing::SceneBuffers& buffers) const override {
    return tracer_.build_without(hidden, std::move(rest), scene, buffers);
  }
  std::unique_ptr<tracing::MovingStructure> build_moving(
      std::shared_ptr<const tracing::AccelerationStructure> rest, const scene::Scene& scene,
      const tracing::SceneTables& tables) const override {
    return tracer_.build_moving(std::move(rest), scene, tables);
  }
  void trace_closest(gpu::FramePlan& plan, const std::string& name,
                     const tracing::AccelerationStructure& structure,
                     const tracing::RayStream& rays, gpu::BufferRef hits) const override {
    cut(plan, name, rays);
    tracer_.trace_closest(plan, name, structure, rays, hits);
  }
  void trace_any(gpu::FramePlan& plan, const std::string& name,
                 const tracing::AccelerationStructure& structure, const tracing::RayStream& rays,
                 gpu::BufferRef occluded) const override {
    cut(plan, name, rays);
    tracer_.trace_any(plan, name, structure, rays, occluded);
  }

 private:
  void cut(gpu::FramePlan& plan, const std::string& name, const tracing::RayStream& rays) const;

  const tracing::RayTracer& tracer_;
  const Programs& programs_;
  const Section& section_;
};

}  // namespace heliograph::render
