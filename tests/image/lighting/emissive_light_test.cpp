#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

protocol::Settings full_reference(int bounces) {
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::full;
  settings.reference.bounces = bounces;
  return settings;
}

/// Sends out light and reflects none.
shared::Material emitter(const glm::vec3& emissive, std::uint32_t flags = 0) {
  shared::Material material = surface(glm::vec3(0.0f), 1.0f, 1.0f);
  material.emissive = emissive;
  material.flags = flags;
  return material;
}

struct Region {
  glm::uvec2 from, to;
};

struct Estimate {
  double mean = 0.0;      // luminance
  double variance = 0.0;  // of one sample of a pixel
  double error = 0.0;     // standard error of the mean
};

/// `samples`: of every pixel of the image.
Estimate estimate(const render::FloatImage& image, std::uint32_t samples, const Region& region) {
  Estimate sum;
  for (std::uint32_t y = region.from.y; y < region.to.y; ++y) {
    for (std::uint32_t x = region.from.x; x < region.to.x; ++x) {
      sum.mean += glm::dot(rgb(image, x, y), glm::vec3(0.2126f, 0.7152f, 0.0722f));
      sum.variance += image.rgba[(std::size_t{y} * image.width + x) * 4 + 3];
    }
  }
  const glm::uvec2 size = region.to - region.from;
  const double pixels = size.x * size.y;
  EXPECT_TRUE(std::isfinite(sum.mean));
  return {sum.mean / pixels, sum.variance / pixels, std::sqrt(sum.variance / samples) / pixels};
}

struct Accumulated {
  render::FloatImage image;
  std::uint32_t samples;

  Estimate of(const Region& region) const { return estimate(image, samples, region); }
  Estimate whole() const { return of({{0, 0}, {image.width, image.height}}); }
};

Accumulated accumulate_lit(const std::string& name,
                           const std::shared_ptr<const scene::Scene>& scene,
                           const scene::Camera& camera, const protocol::Settings& settings,
                           VkExtent2D size, std::uint32_t samples) {
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)), camera, size.width,
                  size.height);
  rig.apply(settings);
  save_image(name, rig.accumulate(samples));
  return {rig.capture("accumulated"), samples};
}

/// Squares of `side` pixels that cover the image.
std::vector<Region> blocks(const render::FloatImage& image, std::uint32_t side) {
  std::vector<Region> all;
  for (std::uint32_t y = 0; y + side <= image.height; y += side) {
    for (std::uint32_t x = 0; x + side <= image.width; x += side) {
      all.push_back({{x, y}, {x + side, y + side}});
    }
  }
  return all;
}

/// Compares the means of blocks of `side` pixels: alike within their noise and one percent.
void expect_same_blocks(const Accumulated& got, const Accumulated& expected, std::uint32_t side) {
  for (const Region& block : blocks(got.image, side)) {
    const Estimate one = got.of(block), other = expected.of(block);
    EXPECT_NEAR(one.mean, other.mean, 0.01 * other.mean + 4.5 * std::hypot(one.error, other.error))
        << "block at " << block.from.x << ", " << block.from.y;
  }
}

/// A floor, a wall and spheres: rough, half rough, metallic and under a clear coat.
void furnish(SceneBuilder& builder) {
  const auto wall = surface({0.7f, 0.6f, 0.5f}, 0.9f);
  builder.place(builder.add_quad({{{-8, 0, 8}, {8, 0, 8}, {8, 0, -3}, {-8, 0, -3}}}, wall));
  builder.place(builder.add_quad({{{-8, 0, -3}, {8, 0, -3}, {8, 8, -3}, {-8, 8, -3}}}, wall));
  const auto at = [](float x) { return glm::translate(glm::mat4(1.0f), {x, 0.6f, 0.5f}); };
  scene::MaterialLayers coat;
  coat.clearcoat = 1.0f;
  coat.clearcoat_roughness = 0.3f;
  builder.place(builder.add_sphere(0.6f, surface({0.6f, 0.2f, 0.2f}, 1.0f)), at(-2.1f));
  builder.place(builder.add_sphere(0.6f, surface({0.2f, 0.6f, 0.2f}, 0.4f)), at(-0.7f));
  builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.8f, 0.5f}, 0.5f, 1.0f)), at(0.7f));
  builder.place(
      builder.add_sphere(0.6f, builder.with_layers(surface({0.2f, 0.2f, 0.6f}, 0.8f), coat)),
      at(2.1f));
}

constexpr glm::vec3 panel_middle(-0.8f, 3.0f, 1.5f);
constexpr float panel_width = 1.6f, panel_height = 0.8f;
constexpr glm::vec3 panel_radiance(6.0f, 5.0f, 4.0f);

TEST(EmissiveLights, QuadMatchesAreaLightOfItsSize) {
  const scene::Camera camera = look({0, 1.8f, 6.5f}, {0, 0.9f, 0}, 38.0f);
  const protocol::Settings settings = full_reference(8);
  SceneBuilder with_light;
  furnish(with_light);
  const auto lit = std::make_shared<scene::Scene>(*with_light.build());
  shared::Light panel{};
  panel.type = shared::light_rectangle;
  panel.position = panel_middle;
  panel.direction = {0, -1, 0};
  panel.tangent = {1, 0, 0};
  panel.color = panel_radiance;
  panel.half_width = 0.5f * panel_width;
  panel.half_height = 0.5f * panel_height;
  lit->lights.push_back({"panel", panel});
  const auto expected = accumulate_lit("quad_as_area_light", lit, camera, settings, {64, 32}, 128);

  SceneBuilder with_quad;
  furnish(with_quad);
  const glm::vec3 x(0.5f * panel_width, 0, 0), z(0, 0, 0.5f * panel_height);
  with_quad.place(with_quad.add_quad(
      {{panel_middle - x - z, panel_middle + x - z, panel_middle + x + z, panel_middle - x + z}},
      emitter(panel_radiance)));
  const auto got =
      accumulate_lit("quad_as_emissive_light", with_quad.build(), camera, settings, {64, 32}, 128);
  expect_same_blocks(got, expected, 16);
  const double ratio = got.whole().mean / expected.whole().mean;
  std::printf("emissive quad: %.4f of the area light's\n", ratio);
  EXPECT_NEAR(ratio, 1.0, 0.01);
}

/// A closed room of 4 metres with coloured walls and a light close under its ceiling, whose back
/// lights up nothing.
std::shared_ptr<const scene::Scene> closed_room(const shared::Material& light) {
  SceneBuilder builder;
  const auto white = surface({0.7f, 0.7f, 0.7f}, 0.8f);
  const auto face = [&](const glm::vec3& middle, const glm::vec3& x, const glm::vec3& y,
                        const shared::Material& material) {
    builder.place(builder.add_quad(
        {{middle - x - y, middle + x - y, middle + x + y, middle - x + y}}, material));
  };
  face({0, 0, 0}, {2, 0, 0}, {0, 0, -2}, white);
  face({0, 4, 0}, {2, 0, 0}, {0, 0, 2}, white);
  face({0, 2, -2}, {2, 0, 0}, {0, 2, 0}, white);
  face({0, 2, 2}, {-2, 0, 0}, {0, 2, 0}, white);
  face({-2, 2, 0}, {0, 0, -2}, {0, 2, 0}, surface({0.7f, 0.1f, 0.1f}, 0.8f));
  face({2, 2, 0}, {0, 0, 2}, {0, 2, 0}, surface({0.1f, 0.6f, 0.1f}, 0.8f));
  face({0, 3.999f, 0}, {0.6f, 0, 0}, {0, 0, 0.6f}, light);
  builder.place(builder.add_sphere(0.7f, surface({0.8f, 0.8f, 0.8f}, 0.3f, 1.0f)),
                glm::translate(glm::mat4(1.0f), {0.7f, 0.7f, -0.5f}));
  return builder.build();
}

// Unlit surfaces send out the same light and are met by chance alone.
TEST(EmissiveLights, SamplingKeepsTheMeanAndLowersTheVariance) {
  const scene::Camera camera = look({0, 2, 1.9f}, {0, 1.6f, 0}, 70.0f);
  const glm::vec3 radiance(5.0f);
  const auto sampled = accumulate_lit("room_sampled", closed_room(emitter(radiance)), camera,
                                      full_reference(8), {48, 48}, 64);
  const auto met =
      accumulate_lit("room_met_by_chance", closed_room(emitter(radiance, shared::material_unlit)),
                     camera, full_reference(8), {48, 48}, 320);
  expect_same_blocks(sampled, met, 16);
  EXPECT_NEAR(sampled.whole().mean / met.whole().mean, 1.0, 0.015);
  // Of the wall: the sphere shows the light itself.
  const Region wall{{12, 0}, {36, 24}};
  const Estimate a = sampled.of(wall), b = met.of(wall);
  std::printf("mean %.4f sampled, %.4f by chance; variance %.4f and %.4f\n", a.mean, b.mean,
              a.variance, b.variance);
  EXPECT_LT(a.variance, 0.05 * b.variance);
}

// A screen of which a part is bright.
TEST(EmissiveLights, TexturedEmissionKeepsTheMean) {
  const auto room = [](std::uint32_t flags) {
    SceneBuilder builder;
    builder.place(builder.add_quad({{{-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}}},
                                   surface(glm::vec3(0.8f))));
    shared::Material screen = emitter({12, 8, 4}, flags | shared::material_double_sided);
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 64; ++i) {
      const std::uint8_t value = i % 8 < 2 && i / 8 < 5 ? 255 : 20;
      pixels.insert(pixels.end(), {value, value, static_cast<std::uint8_t>(value / 2), 255});
    }
    screen.emissive_texture.texture = builder.add_texture(8, 8, true, pixels);
    builder.place(builder.add_quad(
        {{{-1.5f, 0.3f, -2}, {1.5f, 0.3f, -2}, {1.5f, 2.3f, -2}, {-1.5f, 2.3f, -2}}}, screen));
    return builder.build();
  };
  const scene::Camera camera = look({0, 3, 4}, {0, 0, 0}, 40.0f);
  const auto sampled =
      accumulate_lit("screen_sampled", room(0), camera, full_reference(2), {48, 32}, 96);
  const auto met = accumulate_lit("screen_met_by_chance", room(shared::material_unlit), camera,
                                  full_reference(2), {48, 32}, 256);
  expect_same_blocks(sampled, met, 16);
  EXPECT_NEAR(sampled.whole().mean / met.whole().mean, 1.0, 0.01);
  const Region floor{{0, 16}, {48, 32}};
  EXPECT_LT(sampled.of(floor).variance, 0.2 * met.of(floor).variance);
}

/// Six faces around the origin that shine inward, `size` metres from it.
void surround(SceneBuilder& builder, float size, const shared::Material& material) {
  const std::array<glm::vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (const float side : {-1.0f, 1.0f}) {
      const glm::vec3 middle = side * size * axes[i];
      const glm::vec3 x = -side * size * axes[(i + 1) % 3], y = size * axes[(i + 2) % 3];
      builder.place(builder.add_quad(
          {{middle - x - y, middle + x - y, middle + x + y, middle - x + y}}, material));
    }
  }
}

void expect_blocks_of(const Accumulated& got, double value) {
  for (const Region& block : blocks(got.image, 16)) {
    EXPECT_NEAR(got.of(block).mean, value, 0.02 * value) << block.from.x << " " << block.from.y;
  }
}

TEST(EmissiveLights, WhiteSpheresVanishBetweenWallsThatShine) {
  SceneBuilder builder;
  for (int i = 0; i < 10; ++i) {
    const float roughness = 0.25f * static_cast<float>(i % 5);
    const float metallic = i < 5 ? 0.0f : 1.0f;
    const glm::vec3 position(static_cast<float>(i % 5) - 2.0f, i < 5 ? 0.5f : -0.5f, 0);
    builder.place(builder.add_sphere(0.45f, surface(glm::vec3(1.0f), roughness, metallic)),
                  glm::translate(glm::mat4(1.0f), position));
  }
  surround(builder, 7.0f, emitter(glm::vec3(1.0f)));
  const auto image =
      accumulate_lit("emissive_furnace", builder.build(), look({0, 0, 6}, {0, 0, 0}, 36.0f),
                     full_reference(12), {160, 64}, 24);
  expect_blocks_of(image, 1.0);
}

// Walls of albedo a that send out 1 show 1 / (1 - a).
TEST(EmissiveLights, ClosedRoomGathersAllBounces) {
  SceneBuilder builder;
  scene::MaterialLayers no_specular;
  no_specular.specular = 0.0f;
  shared::Material wall = builder.with_layers(surface(glm::vec3(0.6f)), no_specular);
  wall.emissive = glm::vec3(1.0f);
  surround(builder, 2.0f, wall);
  const auto image =
      accumulate_lit("closed_room", builder.build(), look({0, 0, 1}, {0.3f, 0.2f, 0}, 60.0f),
                     full_reference(16), {48, 32}, 48);
  expect_blocks_of(image, 2.5);
}

TEST(EmissiveLights, FollowMaterialsThatAreEdited) {
  const auto scene = closed_room(emitter(glm::vec3(0.0f)));
  const scene::Camera camera = look({0, 2, 1.9f}, {0, 1.6f, 0}, 70.0f);
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)), camera, 32, 32);
  rig.apply(full_reference(4));
  const auto mean_after = [&](const glm::vec3& emissive, std::uint32_t samples) {
    std::vector<shared::Material> materials = scene->materials;
    materials[6].emissive = emissive;
    rig.renderer.set_materials(materials);
    rig.accumulate(samples);
    return Accumulated{rig.capture("accumulated"), samples}.whole().mean;
  };
  rig.accumulate(2);
  EXPECT_EQ((Accumulated{rig.capture("accumulated"), 2}.whole().mean), 0.0);
  const double once = mean_after(glm::vec3(10.0f), 64);
  EXPECT_NEAR(mean_after(glm::vec3(20.0f), 64) / once, 2.0, 0.03);
  EXPECT_EQ(mean_after(glm::vec3(0.0f), 2), 0.0);
  const auto built = accumulate_lit("room_edited", closed_room(emitter(glm::vec3(10.0f))), camera,
                                    full_reference(4), {32, 32}, 64);
  EXPECT_NEAR(built.whole().mean / once, 1.0, 0.01);
}

}  // namespace
}  // namespace heliograph::test
