#include "render/passes/reference/trace_paths.hpp"

#include <utility>

#include "render/kernels/reference/reference.hpp"
#include "render/kernels/specular.hpp"
#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/compose/skybox.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/reference/reference.hpp"
#include "render/passes/reference/reference_lens.hpp"
#include "render/passes/section/section.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::storage;
using tracing::RayKind;

std::span<const EnvironmentCell> environment_cells(const FrameInputs& in) {
  const bool separate_sun = in.settings.environment.separate_sun;
  const gpu::Buffer& cells = in.moving.environment().view(separate_sun).maps.cells;
  return {reinterpret_cast<const EnvironmentCell*>(cells.mapped()),
          cells.size() / sizeof(EnvironmentCell)};
}

/// The paths of some rows.
class PathRounds {
 public:
  PathRounds(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground,
             gpu::ImageRef radiance, gpu::BufferRef paths, const SectionCaps& caps,
             kernels::Rows rows)
      : plan_(plan),
        in_(in),
        background_(in),
        ground_(ground),
        caps_(caps),
        rows_(rows),
        shines_((in.moving.features() & shared::scene_emissive) != 0),
        transmits_((in.moving.features() & shared::scene_transmits) != 0),
        capacity_(camera_ray_capacity(plan.extent().width, rows)),
        radiance_(radiance),
        shadows_(declare_rays(plan, "reference.shadows", capacity_, RayKind::shadow)),
        sky_(declare_rays(plan, "reference.sky", capacity_, RayKind::ambient)),
        emissive_(
            declare_rays(plan, "reference.emissive", shines_ ? capacity_ : 1, RayKind::shadow)),
        paths_(paths),
        hits_(buffer("reference.hits", sizeof(shared::Hit))),
        occluded_(buffer("reference.occluded", sizeof(std::uint32_t))) {}

  void declare() {
    const auto bounces = static_cast<std::uint32_t>(in_.settings.reference.bounces);
    auto current = declare_rays(plan_, "reference.path", capacity_, RayKind::reflection);
    auto next = declare_rays(plan_, "reference.next", capacity_, RayKind::reflection);
    camera_rays(plan_, in_, "reference.camera", current, rows_);
    spread_over_lens(plan_, in_, current);
    // One for every bounce, and for every surface that a path goes straight on through.
    const std::uint32_t rounds = 1 + most_blended + bounces;
    for (std::uint32_t round = 0; round < rounds; ++round) {
      begin_rays(plan_, in_, "reference.path", next, Blending::stops);
      const bool finds_caps = caps_ && round == 0;
      const auto trace = [&] {
        in_.tracer.trace_closest(plan_, "reference.trace", in_.structure, current, hits_);
        if (finds_caps) find_caps(plan_, in_, current, hits_, caps_);
        bounce(round, bounces, current, next);
        add(shadows_);
        add(sky_);
        if (shines_) add(emissive_);
      };
      // The first rays are there in every frame, and so are the caps.
      if (finds_caps) {
        trace();
      } else {
        plan_.only_when(has_rays(plan_, current), trace);
      }
      std::swap(current, next);
    }
  }

 private:
  gpu::BufferRef buffer(const std::string& name, std::size_t element) {
    return plan_.buffer(name, element * capacity_, storage, gpu::Memory::device);
  }

  void bounce(std::uint32_t round, std::uint32_t bounces, const tracing::RayStream& rays,
              const tracing::RayStream& next) {
    plan_.host("reference.bounce", {})
        .bind<kernels::ReferenceBounceBindings>({.rays = ray_source(rays),
                                                 .hits = hits_,
                                                 .paths = paths_,
                                                 .next = ray_sink(next),
                                                 .shadows = ray_sink(shadows_),
                                                 .sky = ray_sink(sky_),
                                                 .emissive = ray_sink(emissive_),
                                                 .radiance = radiance_,
                                                 .ground_shade = ground_})
        .constants(shared::ReferenceConstants{round, bounces, 1, 1.0f})
        .host([in = in_, shines = shines_, transmits = transmits_, seen = background_,
               rows = rows_](const kernels::ReferenceBounceJob::Pass& pass) {
          const auto lights = frame_lights(in.tables.lights, in.constants);
          kernels::reference_bounce({pass, in.constants, lit_scene(in, lights),
                                     environment_cells(in), seen.map(), shines, transmits,
                                     frame_blending(in), rows});
        });
  }

  /// Adds what came along rays that met nothing.
  void add(const tracing::RayStream& lights) {
    in_.tracer.trace_any(plan_, "reference.occlusion", in_.structure, lights, occluded_);
    plan_.pass("reference.add", in_.program(shaders::specular_resolve))
        .bind<kernels::SpecularResolveBindings>(
            {.shadows = ray_source(lights), .occluded = occluded_, .radiance = radiance_})
        .constants(kernels::SpecularResolveConstants{1})
        .dispatch_indirect(lights.count, ray_groups_offset)
        .host(kernels::specular_resolve);
  }

  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  SeenBackground background_;
  gpu::BufferRef ground_;
  const SectionCaps& caps_;
  kernels::Rows rows_;
  bool shines_, transmits_;
  std::uint32_t capacity_;
  gpu::ImageRef radiance_;
  tracing::RayStream shadows_, sky_, emissive_;
  gpu::BufferRef paths_;
  gpu::BufferRef hits_;
  gpu::BufferRef occluded_;
};

}  // namespace

gpu::ImageRef trace_paths(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground) {
  // A ray here takes some 300 bytes, with all that leaves it.
  constexpr std::uint32_t larger_strips = 2;
  const VkExtent2D extent = plan.extent();
  const auto radiance = plan.image(reference_buffers.radiance.name, formats::four_floats);
  plan.host("reference.begin", {})
      .bind<kernels::ReferenceBeginBindings>({.radiance = radiance})
      .dispatch(gpu::each_pixel())
      .host(kernels::reference_begin);
  const auto strips = ray_strips(plan, extent, larger_strips);
  // The first is as high as any.
  const auto paths =
      plan.buffer("reference.paths",
                  sizeof(shared::ReferencePath) * camera_ray_capacity(extent.width, strips.front()),
                  storage, gpu::Memory::device);
  const SectionCaps caps = declare_caps(plan, in, "reference.caps");
  for (const kernels::Rows rows : strips) {
    PathRounds(plan, in, ground, radiance, paths, caps, rows).declare();
  }
  color_caps(plan, in, caps, radiance);
  return radiance;
}

}  // namespace heliograph::render
