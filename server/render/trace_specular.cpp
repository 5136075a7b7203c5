#include "render/trace_specular.hpp"

#include "render/frame.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::render {
namespace {

constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkDeviceSize groups = offsetof(shared::RayCount, groups_x);

tracing::RayStream make_stream(gpu::FramePlan& plan, const FrameInputs& in,
                               const std::string& name, std::uint32_t capacity) {
  const tracing::RayStream stream{
      plan.buffer(name + ".ray_count", sizeof(shared::RayCount),
                  storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, gpu::Memory::device),
      plan.buffer(name + ".rays", sizeof(shared::Ray) * capacity, storage, gpu::Memory::device),
      capacity};
  plan.pass(name + ".begin", in.programs.compute(shaders::begin_rays))
      .write(stream.count)
      .dispatch({1, 1});
  return stream;
}

/// The image that rays write and its size: the plan's, or half of it.
struct Target {
  gpu::ImageRef radiance;
  VkExtent2D extent;
  std::int32_t scale;
};

tracing::RayStream generate_rays(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Target& target) {
  struct Constants {
    float max_roughness;
    std::int32_t scale;
  };
  const auto rays =
      make_stream(plan, in, "specular", target.extent.width * target.extent.height);
  plan.pass("specular.rays", in.programs.compute(shaders::specular_rays))
      .read(gbuffer.normals)
      .read(gbuffer.base_color)
      .read(gbuffer.surface)
      .read(gbuffer.motion)
      .read_write(rays.count)
      .write(rays.rays)
      .write(target.radiance)
      .constants([&s = in.settings.specular, scale = target.scale] {
        return Constants{s.max_roughness, scale};
      })
      .dispatch(target.extent);
  return rays;
}

/// Shades what the rays met; returns the shadow rays of its lamps.
tracing::RayStream shade(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                         const tracing::RayStream& rays, gpu::BufferRef hits,
                         const Target& target) {
  struct Constants {
    std::uint32_t lamps;
    std::int32_t scale;
  };
  const auto shadows = make_stream(plan, in, "specular.shadows", rays.capacity);
  plan.pass("specular.shade", in.programs.compute(shaders::shade_hits))
      .read(gbuffer.surface)
      .read(gbuffer.motion)
      .read(rays.count)
      .read(rays.rays)
      .read(hits)
      .read_write(shadows.count)
      .write(shadows.rays)
      .write(target.radiance)
      .constants([&s = in.settings.specular, scale = target.scale] {
        return Constants{s.hit_shading == protocol::HitShading::traced, scale};
      })
      .dispatch_indirect(rays.count, groups);
  return shadows;
}

}  // namespace

gpu::ImageRef trace_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  Target target{{}, plan.extent(), 1};
  target.radiance =
      plan.image("specular.radiance", VK_FORMAT_R32G32B32A32_SFLOAT, 0, target.extent);
  const auto rays = generate_rays(plan, in, gbuffer, target);
  const auto hits = plan.buffer("specular.hits", sizeof(shared::Hit) * rays.capacity, storage,
                                gpu::Memory::device);
  in.tracer.trace_closest(plan, "specular.trace", in.structure, rays, hits);
  const auto shadows = shade(plan, in, gbuffer, rays, hits, target);
  const auto occluded = plan.buffer("specular.occluded", sizeof(std::uint32_t) * rays.capacity,
                                    storage, gpu::Memory::device);
  in.tracer.trace_any(plan, "specular.shadows.trace", in.structure, shadows, occluded);
  plan.pass("specular.resolve", in.programs.compute(shaders::resolve_specular))
      .read(shadows.count)
      .read(shadows.rays)
      .read(occluded)
      .read_write(target.radiance)
      .constants(target.scale)
      .dispatch_indirect(shadows.count, groups);
  return target.radiance;
}

}  // namespace heliograph::render
