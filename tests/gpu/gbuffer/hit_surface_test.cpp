#include <gtest/gtest.h>

#include <cmath>

#include "render/passes/gbuffer/gbuffer.hpp"
#include "scene/import.hpp"
#include "shaders/shared/ray.h"
#include "tests/gpu/embedded.hpp"
#include "tests/gpu/support/textured_scene.hpp"
#include "tests/gpu/support/uniform_gbuffer.hpp"
#include "tests/support/scene_files.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{160, 120};

glm::vec3 decode(const glm::vec2& p) {
  glm::vec3 d(p.x, p.y, 1.0f - std::abs(p.x) - std::abs(p.y));
  const float below = std::max(-d.z, 0.0f);
  d.x += d.x >= 0.0f ? -below : below;
  d.y += d.y >= 0.0f ? -below : below;
  return glm::normalize(d);
}

/// One view rasterized and traced with camera rays.
struct RasterizedAndTraced {
  RasterizedAndTraced(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera)
      : rig(std::move(scene), camera, {.extent = extent}),
        gbuffer(render::rasterize_gbuffer(rig.plan(), rig.inputs())),
        camera_rays(device(), shaders::camera_rays, layouts()),
        hit_surfaces(device(), shaders::hit_surfaces, layouts()) {
    constexpr std::uint32_t pixels = extent.width * extent.height;
    constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    gpu::FramePlan& plan = rig.plan();
    const tracing::RayStream rays{
        plan.buffer("ray_count", sizeof(shared::RayCount),
                    usage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, gpu::Memory::device),
        plan.buffer("rays", sizeof(shared::Ray) * pixels, usage, gpu::Memory::device), pixels};
    const auto hits = plan.buffer("hits", sizeof(shared::Hit) * pixels, usage, gpu::Memory::device);
    for (gpu::ImageRef* image : {&normals, &color, &surface, &emissive, &place}) {
      *image = plan.image("hit", VK_FORMAT_R32G32B32A32_SFLOAT);
      plan.get(*image).clear();
    }
    plan.pass("camera_rays", camera_rays).write(rays.count).write(rays.rays).dispatch(extent);
    rig.inputs().tracer.trace_closest(plan, "trace", rig.inputs().structure, rays, hits);
    plan.pass("hit_surfaces", hit_surfaces)
        .read(rays.rays)
        .read(hits)
        .write(normals)
        .write(color)
        .write(surface)
        .write(emissive)
        .write(place)
        .dispatch({pixels, 1});
    rig.run();
  }

  static gpu::SharedLayouts layouts() {
    const render::Programs& programs = engine().parts().programs;
    return {{render::frame_set, &programs.frame_layout},
            {render::scene_set, &programs.scene_layout}};
  }

  FrameRig rig;
  render::GBuffer gbuffer;
  gpu::ComputeProgram camera_rays, hit_surfaces;
  gpu::ImageRef normals, color, surface, emissive, place;
};

struct Differences {
  int compared = 0;  // pixels with the same instance in both
  int covered = 0;   // by the rasterizer
  double color = 0.0, roughness = 0.0, metallic = 0.0, shading = 0.0, geometric = 0.0,
         emissive = 0.0;  // means
  double depth = 0.0;     // largest, relative
};

Differences compare(const RasterizedAndTraced& view) {
  const auto read = [&](gpu::ImageRef image) { return view.rig.read(image); };
  const auto normals = read(view.gbuffer.normals), hit_normals = read(view.normals);
  const auto color = read(view.gbuffer.base_color), hit_color = read(view.color);
  const auto surface = read(view.gbuffer.surface), hit_surface = read(view.surface);
  const auto emissive = read(view.gbuffer.emissive), hit_emissive = read(view.emissive);
  const auto motion = read(view.gbuffer.motion), instance = read(view.gbuffer.instance);
  const auto place = read(view.place);
  Differences sum;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const float id = texel(instance, x, y).x;
      sum.covered += id > 0.0f;
      if (id == 0.0f || texel(place, x, y).w != id) continue;
      const glm::vec4 n = texel(normals, x, y), m = texel(hit_normals, x, y);
      const glm::vec4 world(glm::vec3(texel(place, x, y)), 1.0f);
      const float view_z = -(view.rig.constants().view * world).z;
      const double depth = std::abs(view_z / texel(motion, x, y).w - 1.0f);
      if (depth > 0.01) continue;  // another part of the instance, at an edge
      ++sum.compared;
      sum.depth = std::max(sum.depth, depth);
      const glm::vec4 s = texel(surface, x, y) - texel(hit_surface, x, y);
      sum.roughness += std::abs(s.x);
      sum.metallic += std::abs(s.y);
      sum.color += glm::distance(texel(color, x, y), texel(hit_color, x, y));
      sum.shading += glm::distance(decode({n.x, n.y}), decode({m.x, m.y}));
      sum.geometric += glm::distance(decode({n.z, n.w}), decode({m.z, m.w}));
      sum.emissive +=
          glm::distance(glm::vec3(texel(emissive, x, y)), glm::vec3(texel(hit_emissive, x, y)));
    }
  }
  for (double* mean :
       {&sum.color, &sum.roughness, &sum.metallic, &sum.shading, &sum.geometric, &sum.emissive}) {
    *mean /= std::max(sum.compared, 1);
  }
  return sum;
}

TEST(HitSurface, MatchesRasterizer) {
  const auto scene = textured_scene();
  scene::Camera orthographic = look({0.5f, 0.3f, 6}, {0, 0, 0});
  orthographic.orthographic_height = 4.5f;
  for (const scene::Camera& camera : {look({0.3f, 0.4f, 5}, {0, 0, 0}), orthographic}) {
    const Differences mean = compare(RasterizedAndTraced(scene, camera));
    EXPECT_GT(mean.covered, 5000);
    EXPECT_GE(mean.compared, mean.covered * 99 / 100)
        << "rays and rasterizer hit different instances";
    EXPECT_LE(mean.depth, 1e-4);
    EXPECT_LE(mean.color, 0.015);
    EXPECT_LE(mean.roughness, 0.008);
    EXPECT_LE(mean.metallic, 0.008);
    EXPECT_LE(mean.emissive, 0.008);
    EXPECT_LE(mean.shading, 0.02);
    EXPECT_LE(mean.geometric, 0.003);
  }
}

TEST(HitSurface, MatchesRasterizerForDamagedHelmet) {
  const auto file = asset("gltf/DamagedHelmet.glb");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(*file));
  const scene::Camera camera =
      scene::fit_camera(scene->bounds, 40.0f, static_cast<float>(extent.width) / extent.height);
  const Differences mean = compare(RasterizedAndTraced(scene, camera));
  EXPECT_GT(mean.covered, 3000);
  EXPECT_GE(mean.compared, mean.covered * 98 / 100);
  EXPECT_LE(mean.color, 0.04);
  EXPECT_LE(mean.roughness, 0.02);
  EXPECT_LE(mean.metallic, 0.02);
  EXPECT_LE(mean.emissive, 0.02);
  EXPECT_LE(mean.shading, 0.08);
  EXPECT_LE(mean.geometric, 0.01);
}

}  // namespace
}  // namespace heliograph::test
