#include "render/moving_scene.hpp"

namespace heliograph::render {

MovingScene::MovingScene(const gpu::Device&, const tracing::RayTracer&,
                         std::shared_ptr<const SceneResources> rest)
    : rest_(std::move(rest)),
      tables_{rest_->rest_tables.vertices,  rest_->rest_tables.indices,
              rest_->rest_tables.meshes,    rest_->rest_tables.instances,
              rest_->rest_tables.materials, rest_->rest_tables.lights,
              rest_->rest_tables.alpha_heap} {}

}  // namespace heliograph::render
