#include "render/passes/reference/trace_paths.hpp"

#include <utility>

#include "render/kernels/reference/reference.hpp"
#include "render/kernels/specular.hpp"
#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/reference/reference.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving_scene.hpp"
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

class PathRounds {
 public:
  PathRounds(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground)
      : plan_(plan),
        in_(in),
        ground_(ground),
        shines_((in.moving.features() & shared::scene_emissive) != 0),
        capacity_(camera_ray_capacity(plan.extent())),
        radiance_(plan.image(reference_buffers.radiance.name, formats::four_floats)),
        shadows_(declare_rays(plan, "reference.shadows", capacity_, RayKind::shadow)),
        sky_(declare_rays(plan, "reference.sky", capacity_, RayKind::ambient)),
        emissive_(
            declare_rays(plan, "reference.emissive", shines_ ? capacity_ : 1, RayKind::shadow)),
        paths_(buffer("reference.paths", sizeof(shared::ReferencePath))),
        hits_(buffer("reference.hits", sizeof(shared::Hit))),
        occluded_(buffer("reference.occluded", sizeof(std::uint32_t))) {}

  void declare() {
    const auto bounces = static_cast<std::uint32_t>(in_.settings.reference.bounces);
    tracing::RayStream current =
        declare_rays(plan_, "reference.path", capacity_, RayKind::reflection);
    tracing::RayStream next = declare_rays(plan_, "reference.next", capacity_, RayKind::reflection);
    camera_rays(plan_, in_, "reference.camera", current);
    // As many as the camera's rays may take to end, and one for each bounce.
    const std::uint32_t rounds = 1 + most_blended + bounces;
    for (std::uint32_t round = 0; round < rounds; ++round) {
      begin_rays(plan_, in_, "reference.path", next, Blending::stops);
      for (const auto* lights : {&shadows_, &sky_, &emissive_}) {
        begin_rays(plan_, in_, "reference.lights", *lights);
      }
      plan_.only_when(has_rays(plan_, current), [&] {
        in_.tracer.trace_closest(plan_, "reference.trace", in_.structure, current, hits_);
        bounce(round, bounces, current, next);
        add(shadows_);
        add(sky_);
        if (shines_) add(emissive_);
      });
      std::swap(current, next);
    }
  }

  gpu::ImageRef radiance() const { return radiance_; }

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
        .host([in = in_, shines = shines_](const kernels::ReferenceBounceJob::Pass& pass) {
          const auto lights = frame_lights(in.tables.lights, in.constants);
          const LitEnvironment& environment = in.moving.environment();
          const auto chosen = environment.background(in.settings.background);
          const scene::Environment& seen = chosen ? chosen->map : *environment.source();
          kernels::reference_bounce({pass, in.constants, lit_scene(in, lights),
                                     environment_cells(in), kernels::view_map(seen), shines});
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
  gpu::BufferRef ground_;
  bool shines_;
  std::uint32_t capacity_;
  gpu::ImageRef radiance_;
  tracing::RayStream shadows_, sky_, emissive_;
  gpu::BufferRef paths_;
  gpu::BufferRef hits_;
  gpu::BufferRef occluded_;
};

}  // namespace

gpu::ImageRef trace_paths(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground) {
  PathRounds rounds(plan, in, ground);
  rounds.declare();
  return rounds.radiance();
}

}  // namespace heliograph::render
