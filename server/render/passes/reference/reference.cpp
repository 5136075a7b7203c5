#include "render/passes/reference/reference.hpp"

#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/reference/reference_lens.hpp"
#include "render/passes/reference/trace_paths.hpp"
#include "render/passes/section/section.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"
#include "shaders/shared/reference.h"

namespace heliograph::render {
namespace {

constexpr std::uint32_t passed_layers = most_blended;  // that a path goes straight on through
using formats::storage;

auto constants(const FrameInputs& in, std::uint32_t round, std::uint32_t limit) {
  return [&s = in.settings.specular, round, limit] {
    const bool lights = s.hit_shading == protocol::HitShading::traced;
    return shared::ReferenceConstants{round, limit, lights, s.enabled ? s.max_roughness : -1.0f};
  };
}

/// Declares the passes of one sample in waves over all pixels.
class Wavefront {
 public:
  Wavefront(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground)
      : plan_(plan),
        in_(in),
        ground_(ground),
        pixels_(plan.extent().width * plan.extent().height),
        radiance_(plan.image(reference_buffers.radiance.name, VK_FORMAT_R32G32B32A32_SFLOAT)),
        rays_(stream("reference.path")),
        shadows_(stream("reference.shadows")),
        paths_(buffer("reference.paths", sizeof(shared::ReferencePath))),
        hits_(buffer("reference.hits", sizeof(shared::Hit))),
        occluded_(buffer("reference.occluded", sizeof(std::uint32_t))),
        caps_(declare_caps(plan, in, "reference.caps")) {}

  gpu::ImageRef radiance() const { return radiance_; }

  /// After all others.
  void end() { color_caps(plan_, in_, caps_, radiance_); }

  void begin() {
    pass("reference.camera", shaders::reference_camera)
        .write(rays_.count)
        .write(rays_.rays)
        .write(paths_)
        .write(radiance_)
        .dispatch(gpu::each_pixel());
    spread_over_lens(plan_, in_, rays_);
  }

  /// The hybrid's paths: the surface in view, one reflection, and nothing beyond.
  void same_paths() {
    const tracing::RayStream ambient = stream("reference.ambient");
    const tracing::RayStream specular = stream("reference.specular");
    constexpr std::uint32_t rounds = 1 + passed_layers;
    for (std::uint32_t round = 0; round < rounds; ++round) {
      in_.tracer.trace_closest(plan_, "reference.trace", in_.structure, rays_, hits_);
      if (round == 0) find_caps(plan_, in_, rays_, hits_, caps_);
      pass("reference.primary", shaders::reference_primary)
          .read_write(rays_.rays)
          .read(hits_)
          .read_write(paths_)
          .write(shadows_.count)
          .write(shadows_.rays)
          .write(ambient.count)
          .write(ambient.rays)
          .write(specular.count)
          .write(specular.rays)
          .read_write(radiance_)
          .read(ground_)
          .constants(constants(in_, round, rounds))
          .dispatch(gpu::each_pixel());
    }
    add(shadows_);
    add(ambient);
    in_.tracer.trace_closest(plan_, "reference.trace", in_.structure, specular, hits_);
    pass("reference.shade", shaders::reference_shade)
        .read(specular.rays)
        .read(hits_)
        .read(paths_)
        .write(shadows_.count)
        .write(shadows_.rays)
        .read_write(radiance_)
        .constants(constants(in_, rounds, rounds))
        .dispatch(gpu::each_pixel());
    add(shadows_);
  }

  /// Paths of at most `bounces` + 1 vertices.
  void global_illumination(std::uint32_t bounces) {
    const tracing::RayStream sky = stream("reference.sky");
    const bool shines = (in_.moving.features() & shared::scene_emissive) != 0;
    const tracing::RayStream emissive = stream("reference.emissive", shines ? pixels_ : 1);
    const std::uint32_t rounds = 1 + bounces + passed_layers;
    for (std::uint32_t round = 0; round < rounds; ++round) {
      in_.tracer.trace_closest(plan_, "reference.trace", in_.structure, rays_, hits_);
      if (round == 0) find_caps(plan_, in_, rays_, hits_, caps_);
      pass("reference.bounce", shaders::reference_bounce)
          .read_write(rays_.rays)
          .read(hits_)
          .read_write(paths_)
          .write(shadows_.count)
          .write(shadows_.rays)
          .write(sky.count)
          .write(sky.rays)
          .write(emissive.count)
          .write(emissive.rays)
          .read_write(radiance_)
          .read(ground_)
          .constants(constants(in_, round, bounces))
          .dispatch(gpu::each_pixel());
      add(shadows_);
      add(sky);
      if (shines) add(emissive);
    }
  }

 private:
  gpu::PassBuilder pass(const std::string& name, const gpu::ShaderBinary& shader) {
    return plan_.pass(name, in_.program(shader, in_.moving.features()));
  }

  gpu::BufferRef buffer(const std::string& name, std::size_t element) {
    return plan_.buffer(name, element * pixels_, storage, gpu::Memory::device);
  }

  /// A ray of every pixel; without new rays the old ones are traced no more.
  tracing::RayStream stream(const std::string& name) { return stream(name, pixels_); }
  tracing::RayStream stream(const std::string& name, std::uint32_t capacity) {
    const tracing::RayStream made = declare_rays(plan_, name, capacity, tracing::RayKind::path);
    begin_rays(plan_, in_, name, made);
    return made;
  }

  void add(const tracing::RayStream& lights) {
    in_.tracer.trace_any(plan_, "reference.occlusion", in_.structure, lights, occluded_);
    pass("reference.add", shaders::reference_add)
        .read(lights.rays)
        .read(occluded_)
        .read_write(radiance_)
        .dispatch(gpu::each_pixel());
  }

  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  gpu::BufferRef ground_;
  std::uint32_t pixels_;
  gpu::ImageRef radiance_;
  tracing::RayStream rays_;
  tracing::RayStream shadows_;
  gpu::BufferRef paths_;
  gpu::BufferRef hits_;
  gpu::BufferRef occluded_;
  SectionCaps caps_;
};

}  // namespace

bool traces_reference(const FrameInputs& in) {
  return in.settings.reference.use == protocol::ReferenceUse::always ||
         in.clock.hybrid_samples.has_value();
}

gpu::ImageRef trace_reference(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground) {
  const protocol::Settings::Reference& settings = in.settings.reference;
  const bool full = settings.scope == protocol::ReferenceScope::full;
  if (full && plan.uses_host_kernels()) return trace_paths(plan, in, ground);
  Wavefront wavefront(plan, in, ground);
  wavefront.begin();
  if (full) {
    wavefront.global_illumination(static_cast<std::uint32_t>(settings.bounces));
  } else {
    wavefront.same_paths();
  }
  wavefront.end();
  return wavefront.radiance();
}

}  // namespace heliograph::render
