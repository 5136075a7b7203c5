#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

/// A metal floor before a white wall. A point light lights the wall, and a ball casts a shadow on
/// it.
std::shared_ptr<const scene::Scene> floor_and_wall(float roughness) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}},
                                 surface(glm::vec3(0.9f), roughness, 1.0f)));
  builder.place(builder.add_quad({{{-2, 0, -1.9f}, {2, 0, -1.9f}, {2, 3, -1.9f}, {-2, 3, -1.9f}}},
                                 surface(glm::vec3(0.8f))));
  builder.place(builder.add_sphere(0.3f, surface(glm::vec3(0.2f))),
                glm::translate(glm::mat4(1.0f), {0.5f, 1.2f, -1.2f}));
  builder.add_point_light({0, 1.5f, 0}, glm::vec3(3.0f));
  return builder.build();
}

protocol::Settings settings_of(bool from_cache) {
  protocol::Settings settings;
  settings.indirect.rough_reflections = from_cache;
  settings.accumulation.max_samples = 4096;
  settings.accumulation.filter = false;
  settings.antialiasing.temporal = false;
  return settings;
}

struct Reflected {
  render::FloatImage radiance;
  std::uint64_t shadow_rays;  // of the last frame
};

Reflected reflect_light(float roughness, bool from_cache, const std::string& name) {
  RendererRig rig(floor_and_wall(roughness), scene::constant_environment(glm::vec3(0.1f)),
                  look({0, 1.2f, 3.0f}, {0, 0.2f, -1}, 40.0f), 64, 48);
  rig.apply(settings_of(from_cache));
  save_image(name, rig.accumulate(96));
  Reflected made{rig.capture("accumulated"), 0};
  for (const render::PassWork& work : rig.renderer.work()) {
    if (work.name == "specular.shadows.trace") made.shadow_rays += work.rays;
  }
  return made;
}

/// Mean radiance of the floor, by columns of 16 pixels.
std::vector<glm::dvec3> floor_of(const render::FloatImage& image) {
  std::vector<glm::dvec3> columns;
  for (std::uint32_t left = 0; left < 64; left += 16) {
    glm::dvec3 sum(0.0);
    for (std::uint32_t y = 32; y < 48; ++y) {
      for (std::uint32_t x = left; x < left + 16; ++x) sum += glm::dvec3(rgb(image, x, y));
    }
    columns.push_back(sum / 256.0);
  }
  return columns;
}

TEST(CachedReflections, OfRoughSurfacesHaveTheLightOfShadowRays) {
  const Reflected traced = reflect_light(0.7f, false, "cached_reflections_traced");
  const Reflected cached = reflect_light(0.7f, true, "cached_reflections");
  const auto expected = floor_of(traced.radiance), got = floor_of(cached.radiance);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    std::printf("column %zu: %.4f of the light of shadow rays\n", i, got[i].x / expected[i].x);
    EXPECT_NEAR(got[i].x / expected[i].x, 1.0, 0.04) << i;
  }
  EXPECT_LT(cached.shadow_rays, traced.shadow_rays / 2);
}

// It would show the cells.
TEST(CachedReflections, MirrorsTraceShadows) {
  if (!device().is_cpu()) GTEST_SKIP() << "shaders make cells in any order";
  const Reflected traced = reflect_light(0.0f, false, "cached_reflections_mirror_traced");
  const Reflected cached = reflect_light(0.0f, true, "cached_reflections_mirror");
  // The wall is rough, and has fewer of them.
  EXPECT_LT(cached.shadow_rays, traced.shadow_rays);
  EXPECT_EQ(floor_of(cached.radiance), floor_of(traced.radiance));
}

}  // namespace
}  // namespace heliograph::test
