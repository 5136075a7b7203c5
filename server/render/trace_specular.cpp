#include "render/trace_specular.hpp"

#include <optional>

#include "render/ray_stream.hpp"
#include "render/sort_rays.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkFormat four_floats = VK_FORMAT_R32G32B32A32_SFLOAT;

tracing::RayStream make_stream(gpu::FramePlan& plan, const FrameInputs& in,
                               const std::string& name, std::uint32_t capacity) {
  const tracing::RayStream stream = declare_rays(plan, name, capacity);
  begin_rays(plan, in, name, stream);
  return stream;
}

/// What rays write: of the plan's size, or of half of it with the direction of every ray.
struct Target {
  gpu::ImageRef radiance;
  std::optional<gpu::ImageRef> directions;
  VkExtent2D extent;
  std::int32_t scale;
};

Target make_target(gpu::FramePlan& plan, bool half) {
  if (!half) return {plan.image("specular.radiance", four_floats), {}, plan.extent(), 1};
  const VkExtent2D extent{(plan.extent().width + 1) / 2, (plan.extent().height + 1) / 2};
  return {plan.image("specular.half.radiance", four_floats, 0, extent),
          plan.image("specular.half.directions", four_floats, 0, extent), extent, 2};
}

tracing::RayStream generate_rays(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Target& target) {
  const auto rays =
      make_stream(plan, in, "specular", target.extent.width * target.extent.height);
  const auto& shader = target.directions ? shaders::specular_rays_half : shaders::specular_rays;
  auto pass = plan.pass("specular.rays", in.programs.compute(shader));
  pass.read(gbuffer.normals)
      .read(gbuffer.base_color)
      .read(gbuffer.surface)
      .read(gbuffer.motion)
      .read_write(rays.count)
      .write(rays.rays)
      .write(target.radiance)
      .constants([&s = in.settings.specular] { return s.max_roughness; })
      .dispatch(target.extent);
  if (target.directions) pass.write(*target.directions);
  return in.settings.specular.sort_rays ? sort_rays(plan, in, "specular", rays) : rays;
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
  plan.pass("specular.shade", in.programs.compute(shaders::shade_hits, in.scene.features))
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
      .dispatch_indirect(rays.count, ray_groups_offset);
  return shadows;
}

/// Adds the light of lamps that are in view from where the rays ended.
void resolve_lamps(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& shadows,
                   const Target& target) {
  const auto occluded = plan.buffer("specular.occluded", sizeof(std::uint32_t) * shadows.capacity,
                                    storage, gpu::Memory::device);
  in.tracer.trace_any(plan, "specular.shadows.trace", in.structure, shadows, occluded);
  plan.pass("specular.resolve", in.programs.compute(shaders::resolve_specular))
      .read(shadows.count)
      .read(shadows.rays)
      .read(occluded)
      .read_write(target.radiance)
      .constants(target.scale)
      .dispatch_indirect(shadows.count, ray_groups_offset)
      .describe("Reflections of this frame, demodulated; w: how far their rays went, metres.");
}

gpu::ImageRef upsample(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                       const Target& half) {
  const auto radiance = plan.image("specular.radiance", four_floats);
  plan.pass("specular.upsample", in.programs.compute(shaders::upsample_specular))
      .read(gbuffer.normals)
      .read(gbuffer.base_color)
      .read(gbuffer.surface)
      .read(gbuffer.motion)
      .read(half.radiance)
      .read(*half.directions)
      .write(radiance)
      .constants([&s = in.settings.specular] { return s.max_roughness; })
      .dispatch(plan.extent())
      .describe("Reflections of this frame, demodulated; w: how far their rays went, metres.");
  return radiance;
}

}  // namespace

gpu::ImageRef trace_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  const Target target = make_target(plan, in.settings.specular.half_resolution);
  const auto rays = generate_rays(plan, in, gbuffer, target);
  const auto hits = plan.buffer("specular.hits", sizeof(shared::Hit) * rays.capacity, storage,
                                gpu::Memory::device);
  in.tracer.trace_closest(plan, "specular.trace", in.structure, rays, hits);
  const auto shadows = shade(plan, in, gbuffer, rays, hits, target);
  resolve_lamps(plan, in, shadows, target);
  return target.directions ? upsample(plan, in, gbuffer, target) : target.radiance;
}

}  // namespace heliograph::render
