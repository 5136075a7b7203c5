#include "render/passes/rays/sort_rays.hpp"

#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"
#include "shaders/shared/ray_sorting.h"

namespace heliograph::render {

tracing::RayStream sort_rays(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                             const tracing::RayStream& rays) {
  constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  constexpr VkDeviceSize groups = offsetof(shared::RayCount, groups_x);
  const auto offsets = plan.buffer(name + ".sort.offsets", sizeof(std::uint32_t) * shared::ray_keys,
                                   storage, gpu::Memory::device);
  const tracing::RayStream sorted{
      rays.count,
      plan.buffer(name + ".sorted_rays", sizeof(shared::Ray) * rays.capacity, storage,
                  gpu::Memory::device),
      rays.capacity, rays.kind};
  const scene::Bounds bounds = in.scene.scene->bounds;
  const auto constants = [bounds] {
    const glm::vec3 size = glm::max(bounds.maximum - bounds.minimum, glm::vec3(1e-6f));
    return shared::RaySortConstants{glm::vec4(bounds.minimum, 0.0f), glm::vec4(1.0f / size, 0.0f)};
  };
  plan.pass(name + ".sort.clear", in.program(shaders::rays_sort_clear))
      .write(offsets)
      .dispatch({shared::ray_keys, 1});
  plan.pass(name + ".sort.count", in.program(shaders::rays_sort_count))
      .read(rays.count)
      .read(rays.rays)
      .read_write(offsets)
      .constants(constants)
      .dispatch_indirect(rays.count, groups);
  plan.pass(name + ".sort.offsets", in.program(shaders::rays_sort_offsets))
      .read_write(offsets)
      .dispatch({256, 1});
  plan.pass(name + ".sort.move", in.program(shaders::rays_sort_move))
      .read(rays.count)
      .read(rays.rays)
      .read_write(offsets)
      .write(sorted.rays)
      .constants(constants)
      .dispatch_indirect(rays.count, groups);
  return sorted;
}

}  // namespace heliograph::render
