#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "render/kernels/common/ray_sink.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/section.h"

/// What section planes do to rays and to the surfaces in view, on all processors.
namespace heliograph::render::kernels {

/// shaders/section/section_rays.comp
template <class Stage>
struct SectionRaysBindings {
  gpu::ReadBuffer<Stage, shared::RayCount> count;
  gpu::ReadWriteBuffer<Stage, shared::Ray> rays;
};
using SectionRaysJob = gpu::HostPass<SectionRaysBindings, shared::SectionConstants>;
void section_rays(const SectionRaysJob& job);

/// Of a pixel: number of the plane + 1, instance + 1; 0: no cap.
using SectionCap = glm::uvec2;

/// shaders/section/section_find.comp
template <class Stage>
struct SectionFindBindings {
  RaySource<Stage> rays;
  gpu::ReadBuffer<Stage, shared::Hit> hits;
  gpu::WriteBuffer<Stage, SectionCap> caps;
};
struct SectionFindJob : FrameJob<SectionFindBindings, shared::SectionConstants> {
  SceneView scene;
};
void section_find(const SectionFindJob& job);

/// shaders/section/section_draw.comp
template <class Stage>
struct SectionDrawBindings {
  gpu::ReadBuffer<Stage, SectionCap> caps;
  gpu::ReadWrite<Stage> normals;      // rgba32f
  gpu::ReadWrite<Stage> base_color;   // rgba8
  gpu::ReadWrite<Stage> surface;      // rgba8
  gpu::ReadWrite<Stage> motion;       // rgba32f
  gpu::ReadWrite<Stage> emissive;     // rgba16f
  gpu::ReadWrite<Stage> depth_slope;  // rg32f
  gpu::ReadWrite<Stage> instance;     // r32ui
};
using SectionDrawJob = FrameJob<SectionDrawBindings, shared::SectionConstants>;
void section_draw(const SectionDrawJob& job);

/// shaders/section/section_color.comp
template <class Stage>
struct SectionColorBindings {
  gpu::ReadBuffer<Stage, SectionCap> caps;
  gpu::ReadWrite<Stage> radiance;  // rgba32f
};
using SectionColorJob = gpu::HostPass<SectionColorBindings, shared::SectionConstants>;
void section_color(const SectionColorJob& job);

}  // namespace heliograph::render::kernels
