#include "render/passes/section/section_tracer.hpp"

#include <algorithm>
#include <stdexcept>

#include "protocol/limits.hpp"
#include "render/kernels/section/section.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

shared::SectionConstants section_constants(const Section& section) {
  static_assert(protocol::max_section_planes == shared::most_section_planes);
  if (section.planes.size() > shared::most_section_planes) {
    throw std::invalid_argument("a section has at most 6 planes");
  }
  shared::SectionConstants constants{};
  std::ranges::copy(section.planes, constants.planes);
  constants.cap_color = section.cap_color;
  constants.count = static_cast<std::uint32_t>(section.planes.size());
  return constants;
}

void SectionTracer::cut(gpu::FramePlan& plan, const std::string& name,
                        const tracing::RayStream& rays) const {
  plan.pass(name + ".section",
            [&programs = programs_]() -> const gpu::ComputeProgram& {
              return programs.compute(shaders::section_rays);
            })
      .bind<kernels::SectionRaysBindings>({.count = rays.count, .rays = rays.rays})
      .constants([&section = section_] { return section_constants(section); })
      .dispatch_indirect(rays.count, ray_groups_offset)
      .host(kernels::section_rays);
}

}  // namespace heliograph::render
