#pragma once

#include <memory>

#include "render/scene_resources.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// A scene as one renderer sees it: the shared resources at rest, and over them what moves.
class MovingScene {
 public:
  MovingScene(const gpu::Device& device, const tracing::RayTracer& tracer,
              std::shared_ptr<const SceneResources> rest);

  const SceneResources& rest() const { return *rest_; }
  const tracing::SceneTables& tables() const { return tables_; }
  const tracing::AccelerationStructure& structure() const { return *rest_->rest_structure; }

 private:
  std::shared_ptr<const SceneResources> rest_;
  tracing::SceneTables tables_;
};

}  // namespace heliograph::render
