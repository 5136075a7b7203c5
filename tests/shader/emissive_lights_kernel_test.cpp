// Host kernels draw the same points of emissive triangles as shaders.

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "render/kernels/simd/emissive_lights.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::test {
namespace {

namespace kernels = render::kernels::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;

/// A textured screen, a masked one, a blended one and one that shines on both sides.
std::shared_ptr<const scene::Scene> four_squares() {
  SceneBuilder builder;
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 64; ++i) {
    const auto value = static_cast<std::uint8_t>(i * 4);
    pixels.insert(pixels.end(), {value, 128, 20, value});
  }
  const std::uint32_t texture = builder.add_texture(8, 8, true, pixels);
  constexpr std::array<std::uint32_t, 4> flags{
      0, shared::material_alpha_mask, shared::material_alpha_blend, shared::material_double_sided};
  for (std::size_t i = 0; i < flags.size(); ++i) {
    shared::Material material = surface(glm::vec3(0.5f));
    material.emissive = {2.0f, 1.0f, 0.5f};
    material.flags = flags[i];
    if (i < 3) material.emissive_texture.texture = material.base_color_texture.texture = texture;
    const auto quad =
        builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, material);
    const float x = 3.0f * static_cast<float>(i);
    builder.place(quad, glm::scale(glm::translate(glm::mat4(1.0f), {x, 0, 0}),
                                   glm::vec3(i == 2 ? -1.5f : 1.0f, 1, 1)));
  }
  return builder.build();
}

/// What the shader test's function 0 gives.
ShaderOutput sample_on_host(const render::kernels::SceneView& scene, const ShaderInput& given) {
  const kernels::HitLanes drawn =
      kernels::draw_emissive(scene, {kernels::number(given.a.x), kernels::number(given.a.y)},
                             {kernels::number(given.a.z), kernels::number(given.a.w)});
  const kernels::EmissiveLanes s = kernels::emissive_sample<false>(
      scene, drawn, kernels::numbers(glm::vec3(given.b)), kernels::zero(), kernels::zero());
  const auto lane = [](const kernels::Float3& v) {
    return glm::vec3(hn::GetLane(v.x), hn::GetLane(v.y), hn::GetLane(v.z));
  };
  return {glm::vec4(lane(s.position), hn::GetLane(s.density)),
          glm::vec4(lane(s.emission), static_cast<float>(hn::GetLane(drawn.instance)))};
}

TEST(EmissiveKernel, DrawsThePointsOfTheShader) {
  FrameRig rig(four_squares(), look({0, 0, 9}, {0, 0, 0}));
  if (!device().is_cpu()) GTEST_SKIP() << "the host reads tables of CPU devices only";
  const auto scene = render::kernels::view_scene(rig.scene(), rig.moving().tables(), rig.moving());
  RandomInputs random(11);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 3000; ++i) {
    inputs.push_back(
        {.a = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1),
               random.uniform(0, 1)},
         .b = {random.uniform(-2, 12), random.uniform(-3, 3), random.uniform(-4, 4), 0}});
  }
  const auto shader = ShaderFunctions(shaders::emissive_lights, &rig).call(0, inputs);
  std::array<int, 4> lit{};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const ShaderOutput host = sample_on_host(scene, inputs[i]);
    ASSERT_EQ(host.y.w, shader[i].y.w) << i;
    ASSERT_LE(glm::distance(glm::vec3(host.x), glm::vec3(shader[i].x)), 1e-4f) << i;
    ASSERT_NEAR(host.x.w, shader[i].x.w, 1e-4f * shader[i].x.w) << i;
    ASSERT_LE(glm::distance(glm::vec3(host.y), glm::vec3(shader[i].y)), 0.01f) << i;
    lit[static_cast<std::size_t>(host.y.w)] += host.y.y > 0.0f;
  }
  for (const int count : lit) EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace heliograph::test
HWY_AFTER_NAMESPACE();
