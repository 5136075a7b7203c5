#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

protocol::Settings gathered_box() {
  protocol::Settings settings;
  settings.indirect.enabled = true;
  settings.accumulation.max_samples = 4096;
  settings.antialiasing.temporal = false;
  return settings;
}

protocol::Settings path_traced_box() {
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::full;
  settings.reference.bounces = 16;
  return settings;
}

constexpr float ceiling_light_half = 0.3f, ceiling_light_height = 0.98f;
constexpr glm::vec3 ceiling_light_radiance(9.0f, 7.5f, 5.0f);

/// Sends out light and reflects none.
shared::Material shining(std::uint32_t flags = 0) {
  shared::Material material = surface(glm::vec3(0.0f), 1.0f, 1.0f);
  material.emissive = ceiling_light_radiance;
  material.flags = flags;
  return material;
}

/// A box from -1 to 1 with a red and a green wall, open toward the eye, and a sphere.
void add_box(SceneBuilder& builder) {
  const shared::Material white = surface(glm::vec3(0.73f));
  const auto wall = [&](const glm::vec3& middle, const glm::vec3& x, const glm::vec3& y,
                        const shared::Material& material) {
    builder.place(builder.add_quad(
        {{middle - x - y, middle + x - y, middle + x + y, middle - x + y}}, material));
  };
  wall({0, -1, 0}, {1, 0, 0}, {0, 0, -1}, white);
  wall({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, white);
  wall({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, white);
  wall({-1, 0, 0}, {0, 0, -1}, {0, 1, 0}, surface({0.65f, 0.05f, 0.05f}));
  wall({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, surface({0.12f, 0.45f, 0.15f}));
  builder.place(builder.add_sphere(0.4f, white),
                glm::translate(glm::mat4(1.0f), {0.3f, -0.6f, -0.2f}));
}

/// The light in `parts` x `parts` squares.
void add_panel(SceneBuilder& builder, int parts, const shared::Material& material) {
  const float half = ceiling_light_half / static_cast<float>(parts);
  const glm::vec3 x(half, 0, 0), z(0, 0, half);
  const auto square = builder.add_quad({{-x - z, x - z, x + z, -x + z}}, material);
  for (int i = 0; i < parts * parts; ++i) {
    const auto place = [&](int step) {
      return (2.0f * float(step) + 1.0f) * half - ceiling_light_half;
    };
    builder.place(square, glm::translate(glm::mat4(1.0f), {place(i % parts), ceiling_light_height,
                                                           place(i / parts)}));
  }
}

std::shared_ptr<const scene::Scene> box_with_panel(int parts, const shared::Material& material) {
  SceneBuilder builder;
  add_box(builder);
  add_panel(builder, parts, material);
  return builder.build();
}

constexpr std::uint32_t box_pixels = 60;

scene::Camera eye() {
  return look({0, 0, 3.6f}, {0, 0, 0}, 38.0f);
}

render::FloatImage accumulated_box(const std::string& name,
                                   const std::shared_ptr<const scene::Scene>& scene,
                                   const protocol::Settings& settings, std::uint32_t samples) {
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)), eye(), box_pixels,
                  box_pixels);
  rig.apply(settings);
  // While the cache learns; then the mean starts again.
  rig.accumulate(48);
  rig.renderer.set_camera(look({0, 0, 3.6001f}, {0, 0, 0}, 38.0f));
  save_image(name, rig.accumulate(samples));
  return rig.capture("accumulated");
}

glm::dvec3 mean_of_part(const render::FloatImage& image, glm::uvec2 from, glm::uvec2 to) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t y = from.y; y < to.y; ++y) {
    for (std::uint32_t x = from.x; x < to.x; ++x) sum += glm::dvec3(rgb(image, x, y));
  }
  return sum / (double(to.x - from.x) * double(to.y - from.y));
}

struct BoxPart {
  const char* name;
  glm::uvec2 from, to;
};
constexpr std::array<BoxPart, 6> box_parts{{{"red", {3, 18}, {9, 42}},
                                            {"green", {51, 18}, {57, 42}},
                                            {"floor", {20, 52}, {40, 57}},
                                            {"ceiling", {12, 3}, {22, 8}},
                                            {"back", {16, 16}, {34, 30}},
                                            {"sphere", {33, 38}, {39, 44}}}};

void expect_alike(const render::FloatImage& got, const render::FloatImage& expected,
                  double tolerance) {
  for (const BoxPart& region : box_parts) {
    const glm::dvec3 is = mean_of_part(got, region.from, region.to);
    const glm::dvec3 truth = mean_of_part(expected, region.from, region.to);
    std::printf("%s: %.3f %.3f %.3f of the expected\n", region.name, is.x / truth.x, is.y / truth.y,
                is.z / truth.z);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(is[c], truth[c], tolerance * truth[c] + 0.004) << region.name << " " << c;
    }
  }
}

TEST(EmissiveIndirect, PanelLightsABoxAsTheReferenceDoes) {
  const auto scene = box_with_panel(1, shining());
  const auto expected = accumulated_box("emissive_panel_reference", scene, path_traced_box(), 256);
  expect_alike(accumulated_box("emissive_panel", scene, gathered_box(), 160), expected, 0.03);
}

TEST(EmissiveIndirect, PanelMatchesAreaLightOfItsSize) {
  SceneBuilder builder;
  add_box(builder);
  const auto lit = std::make_shared<scene::Scene>(*builder.build());
  shared::Light panel{};
  panel.type = shared::light_rectangle;
  panel.position = {0, ceiling_light_height, 0};
  panel.direction = {0, -1, 0};
  panel.tangent = {1, 0, 0};
  panel.color = ceiling_light_radiance;
  panel.half_width = panel.half_height = ceiling_light_half;
  lit->lights.push_back({"panel", panel});
  const auto expected = accumulated_box("emissive_panel_as_light", lit, gathered_box(), 160);
  expect_alike(accumulated_box("emissive_panel", box_with_panel(1, shining()), gathered_box(), 160),
               expected, 0.03);
}

TEST(EmissiveIndirect, ThousandsOfTrianglesAreAsBrightAsTwo) {
  const auto expected =
      accumulated_box("emissive_panel", box_with_panel(1, shining()), gathered_box(), 160);
  expect_alike(accumulated_box("emissive_panel_in_parts", box_with_panel(40, shining()),
                               gathered_box(), 160),
               expected, 0.03);
}

/// The panel below a black plate: unlit surfaces shine on both sides, others only in front.
std::shared_ptr<const scene::Scene> box_with_one_sided_panel(int parts,
                                                             const shared::Material& material) {
  SceneBuilder builder;
  add_box(builder);
  add_panel(builder, parts, material);
  const float half = ceiling_light_half + 0.05f, height = ceiling_light_height + 0.002f;
  const glm::vec3 middle(0, height, 0), x(half, 0, 0), z(0, 0, half);
  builder.place(builder.add_quad({{middle - x - z, middle + x - z, middle + x + z, middle - x + z}},
                                 surface(glm::vec3(0.0f))));
  return builder.build();
}

/// Mean and variance of single samples on the floor, the mean of several frames.
glm::dvec2 moments_of_samples(const shared::Material& material, int parts) {
  RendererRig rig(box_with_one_sided_panel(parts, material),
                  scene::constant_environment(glm::vec3(0.0f)), eye(), box_pixels, box_pixels);
  rig.apply(gathered_box());
  rig.accumulate(64);
  glm::dvec2 sum(0.0);
  int count = 0;
  for (int i = 0; i < 96; ++i) {
    rig.renderer.render();
    const render::FloatImage radiance = rig.capture("indirect.radiance");
    for (std::uint32_t y = 52; y < 57; ++y) {
      for (std::uint32_t x = 20; x < 40; ++x, ++count) {
        const double value = rgb(radiance, x, y).y;
        sum += glm::dvec2(value, value * value);
      }
    }
  }
  sum /= count;
  return {sum.x, sum.y - sum.x * sum.x};
}

// Unlit surfaces send out the same light and are met by chance alone.
TEST(EmissiveIndirect, ShadowRaysLowerTheVarianceOfSamples) {
  const glm::dvec2 chance = moments_of_samples(shining(shared::material_unlit), 1);
  const glm::dvec2 sampled = moments_of_samples(shining(), 1);
  const glm::dvec2 in_parts = moments_of_samples(shining(), 40);
  std::printf("mean %.4f, %.4f, %.4f; variance %.4f by chance, %.4f sampled, %.4f of 3200\n",
              chance.x, sampled.x, in_parts.x, chance.y, sampled.y, in_parts.y);
  EXPECT_NEAR(sampled.x / chance.x, 1.0, 0.1);
  EXPECT_LT(sampled.y, 0.2 * chance.y);
  EXPECT_LT(in_parts.y, 2.0 * sampled.y);
}

}  // namespace
}  // namespace heliograph::test
