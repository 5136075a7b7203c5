#include <gtest/gtest.h>

#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/section/section_tracer.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// A ball on a floor, which two planes cut.
std::shared_ptr<const scene::Scene> cut_ball() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}}},
                                 surface({0.6f, 0.5f, 0.4f}, 0.8f)));
  builder.place(builder.add_sphere(1.0f, surface({0.2f, 0.3f, 0.9f}, 0.5f)));
  return builder.build();
}

const render::Section two_planes{.planes = {{0, 0, 1, 0.2f}, {0.6f, 0.8f, 0, 0.5f}}};

TEST(SectionKernel, CutsAndClosesAsShadersDo) {
  if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  for (const bool orthographic : {false, true}) {
    scene::Camera camera = look({1.5f, 1.2f, 3.5f}, {0, 0, 0}, 45.0f);
    if (orthographic) camera.orthographic_height = 4.0f;
    FrameRig rig(cut_ball(), camera, {.extent = {120, 90}});
    rig.moving().set_section(two_planes);
    const render::FrameInputs& rig_inputs = rig.inputs();
    const render::SectionTracer tracer(rig_inputs.tracer, rig_inputs.programs,
                                       rig.moving().section());
    const auto trace = [&](bool host) {
      return render::trace_gbuffer(rig.plan(), with_tracer(with_host_kernels(rig, host), tracer));
    };
    const render::GBuffer shader = trace(false), host = trace(true);
    scene::Camera moved = camera;
    moved.eye += glm::vec3(0.05f, -0.02f, 0.03f);
    rig.set_view(moved, 3);
    rig.run();
    expect_same_gbuffer(rig, shader, host, orthographic ? "orthographic" : "perspective");
    // Unlit pixels are caps: both planes have some.
    const render::FloatImage kinds = rig.read(host.surface), normals = rig.read(host.normals);
    std::set<std::pair<float, float>> caps;
    for (std::size_t i = 0; i < kinds.rgba.size(); i += 4) {
      if (kinds.rgba[i + 2] > 0.5f) caps.insert({normals.rgba[i], normals.rgba[i + 1]});
    }
    EXPECT_EQ(caps.size(), 2u) << orthographic;
  }
}

}  // namespace
}  // namespace heliograph::test
