#include "render/passes/reflections/trace_specular.hpp"

#include <optional>

#include "render/kernels/specular.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/rays/sort_rays.hpp"
#include "render/resources/light_table.hpp"
#include "render/resources/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::four_floats;
using formats::storage;

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

kernels::SplitSum split_sum(const FrameInputs& in) {
  const gpu::Image& table = in.split_sum_table;
  return {table.host(), static_cast<int>(table.desc().extent.width)};
}

tracing::RayStream generate_rays(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Target& target) {
  const auto rays = declare_rays(plan, "specular", target.extent.width * target.extent.height);
  const auto bind = [&](gpu::PassBuilder pass) {
    pass.read(gbuffer.normals)
        .read(gbuffer.base_color)
        .read(gbuffer.surface)
        .read(gbuffer.layers)
        .read(gbuffer.motion)
        .read_write(rays.count)
        .write(rays.rays)
        .write(target.radiance);
    return target.directions ? pass.write(*target.directions) : pass;
  };
  const auto run_host = [&plan, in, gbuffer, target, rays] {
    const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
    std::optional<gpu::HostView> directions;
    if (target.directions) directions = view(*target.directions);
    kernels::make_specular_rays({in.constants, split_sum(in), in.settings.specular.max_roughness,
                                 view(gbuffer.normals), view(gbuffer.base_color),
                                 view(gbuffer.surface), view(gbuffer.motion),
                                 ray_sink(plan, in, rays), view(target.radiance), directions});
  };
  if (shades_on_host(plan, in)) {
    bind(plan.host("specular.rays", run_host));
  } else {
    const auto& shader = target.directions ? shaders::specular_rays_half : shaders::specular_rays;
    begin_rays(plan, in, "specular", rays);
    bind(plan.pass("specular.rays", in.programs.compute(shader, in.scene.features)))
        .constants([&s = in.settings.specular] { return s.max_roughness; })
        .dispatch(target.extent);
  }
  return in.settings.specular.sort_rays ? sort_rays(plan, in, "specular", rays) : rays;
}

/// What the rays met, and the shadow rays of its lamps.
struct Hits {
  std::string name;
  tracing::RayStream rays;
  gpu::BufferRef hits;
  tracing::RayStream shadows;
};

void shade_on_host(const gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                   const Hits& hits, const Target& target) {
  const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
  const auto lights = frame_lights(in.tables.lights, in.constants);
  const bool separate_sun = in.settings.environment.separate_sun;
  kernels::shade_hits({in.constants, kernels::view_scene(in.scene, in.tables, in.moving),
                       *in.moving.environment().view(separate_sun).maps.host, lights, split_sum(in),
                       in.settings.specular.hit_shading == protocol::HitShading::traced,
                       target.scale, view(gbuffer.surface), view(gbuffer.motion),
                       ray_source(plan, hits.rays), mapped<const shared::Hit>(plan, hits.hits),
                       ray_sink(plan, in, hits.shadows), view(target.radiance)});
}

/// Shades what the rays met; makes the shadow rays of its lamps.
void shade(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer, const Hits& hits,
           const Target& target) {
  struct Constants {
    std::uint32_t lamps;
    std::int32_t scale;
  };
  const auto bind = [&](gpu::PassBuilder pass) {
    return pass.read(gbuffer.surface)
        .read(gbuffer.motion)
        .read(hits.rays.count)
        .read(hits.rays.rays)
        .read(hits.hits)
        .read_write(hits.shadows.count)
        .write(hits.shadows.rays)
        .write(target.radiance);
  };
  // The kernel knows punctual lights alone.
  if (shades_on_host(plan, in) && (in.scene.features & shared::scene_area_lights) == 0) {
    bind(plan.host(hits.name + ".shade", [&plan, in, gbuffer, hits, target] {
      shade_on_host(plan, in, gbuffer, hits, target);
    }));
    return;
  }
  begin_rays(plan, in, hits.name + ".shadows", hits.shadows);
  bind(plan.pass(hits.name + ".shade",
                 in.programs.compute(shaders::specular_shade, in.scene.features)))
      .constants([&s = in.settings.specular, scale = target.scale] {
        return Constants{s.hit_shading == protocol::HitShading::traced, scale};
      })
      .dispatch_indirect(hits.rays.count, ray_groups_offset);
}

/// Adds the light of lamps that are in view from where the rays ended.
void resolve_lights(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                    const tracing::RayStream& shadows, const Target& target) {
  const auto occluded = plan.buffer(name + ".occluded", sizeof(std::uint32_t) * shadows.capacity,
                                    storage, gpu::Memory::device);
  in.tracer.trace_any(plan, name + ".shadows.trace", in.structure, shadows, occluded);
  const auto bind = [&](gpu::PassBuilder pass) {
    return pass.read(shadows.count).read(shadows.rays).read(occluded).read_write(target.radiance);
  };
  if (by_host(plan, in)) {
    bind(plan.host(name + ".resolve", [&plan, shadows, occluded, target] {
      kernels::resolve_lights(ray_source(plan, shadows),
                              mapped<const std::uint32_t>(plan, occluded), target.scale,
                              plan.get(target.radiance).host());
    }));
    return;
  }
  bind(plan.pass(name + ".resolve", in.programs.compute(shaders::specular_resolve)))
      .constants(target.scale)
      .dispatch_indirect(shadows.count, ray_groups_offset);
}

/// What the rays meet, lit.
void trace_and_shade(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                     const tracing::RayStream& rays, const GBuffer& gbuffer, const Target& target) {
  const auto hits = plan.buffer(name + ".hits", sizeof(shared::Hit) * rays.capacity, storage,
                                gpu::Memory::device);
  in.tracer.trace_closest(plan, name + ".trace", in.structure, rays, hits);
  const auto shadows = declare_rays(plan, name + ".shadows", rays.capacity);
  shade(plan, in, gbuffer, {name, rays, hits, shadows}, target);
  resolve_lights(plan, in, name, shadows, target);
}

gpu::ImageRef upsample(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                       const Target& half) {
  const auto radiance = plan.image("specular.radiance", four_floats);
  plan.pass("specular.upsample", in.programs.compute(shaders::specular_upsample, in.scene.features))
      .read(gbuffer.normals)
      .read(gbuffer.base_color)
      .read(gbuffer.surface)
      .read(gbuffer.layers)
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
  trace_and_shade(plan, in, "specular", rays, gbuffer, target);
  return target.directions ? upsample(plan, in, gbuffer, target) : target.radiance;
}

void trace_mirrored(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                    const tracing::RayStream& rays, gpu::ImageRef surface, gpu::ImageRef distance,
                    gpu::ImageRef radiance) {
  GBuffer mirrors;
  mirrors.surface = surface;
  mirrors.motion = distance;
  trace_and_shade(plan, in, name, rays, mirrors, {radiance, {}, plan.extent(), 1});
}

void add_unhidden_light(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                        const tracing::RayStream& rays, gpu::ImageRef radiance) {
  resolve_lights(plan, in, name, rays, {radiance, {}, plan.extent(), 1});
}

}  // namespace heliograph::render
