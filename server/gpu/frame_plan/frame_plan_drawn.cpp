// The size that frames are drawn at.

#include "gpu/frame_plan/frame_plan_parts.hpp"
#include "gpu/memory/rescale.hpp"

namespace heliograph::gpu {

void FramePlan::set_drawn(VkExtent2D drawn) {
  if (drawn.width > extent_.width || drawn.height > extent_.height) {
    throw GpuError("frames are drawn at most at the size of their plan");
  }
  if (drawn.width == drawn_.width && drawn.height == drawn_.height) return;
  for (const Resource& resource : resources_) {
    if (resource.part != Resource::Part::current || !resource.size.follows_frame()) continue;
    const auto& images = resource.owned_images;
    rescale(device_, *images[parity_ ^ 1], *images[parity_], resource.size.of(drawn_),
            resource.size.of(drawn));
  }
  drawn_ = drawn;
}

VkExtent2D FramePlan::drawn(ImageRef image) const {
  return resources_[image.index].size.of(drawn_);
}

}  // namespace heliograph::gpu
