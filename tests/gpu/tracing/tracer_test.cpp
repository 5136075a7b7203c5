#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "scene/import.hpp"
#include "tests/gpu/tracing/tracer_rig.hpp"

namespace heliograph::tracing {
namespace {

TEST_P(TracerTest, MatchesBruteForce) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const scene::Scene scene = two_level_scene(seed);
    const std::vector<shared::Ray> rays = random_rays(scene, 5000, seed);
    const TraceResults expected = brute_force(scene, rays);
    const TraceResults results = traced(scene, GetParam()).trace(rays);
    EXPECT_GT(hit_count(expected), rays.size() / 6) << "too few hits for a test";
    EXPECT_LT(hit_count(expected), rays.size() * 3 / 4);
    EXPECT_LT(disagreement(results, expected), 1e-3) << "seed " << seed;
  }
}

TEST_P(TracerTest, BarycentricsAgreeWithDistance) {
  const scene::Scene scene = two_level_scene(4);
  const std::vector<shared::Ray> rays = random_rays(scene, 5000, 4);
  const TraceResults results = traced(scene, GetParam()).trace(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const shared::Hit& hit = results.hits[i];
    if (hit.instance == shared::hit_none) {
      EXPECT_EQ(hit.t, rays[i].t_max);
      continue;
    }
    ASSERT_LT(hit.instance, scene.instances.size());
    const auto& [mesh_index, node] = scene.instances[hit.instance];
    const scene::Mesh& mesh = scene.meshes[mesh_index];
    ASSERT_LT(hit.triangle, mesh.indices.size() / 3);
    const auto corner = [&](std::size_t c) {
      return mesh.vertices[mesh.indices[3 * std::size_t(hit.triangle) + c]].position;
    };
    const glm::vec3 point =
        (1.0f - hit.u - hit.v) * corner(0) + hit.u * corner(1) + hit.v * corner(2);
    const glm::vec3 world = glm::vec3(scene.nodes[node].world * glm::vec4(point, 1.0f));
    EXPECT_LT(glm::distance(world, rays[i].origin + hit.t * rays[i].direction), 1e-4f);
    EXPECT_GT(hit.t, rays[i].t_min);
    EXPECT_LT(hit.t, rays[i].t_max);
  }
}

/// Rays straight down onto the quad, several per texel.
std::vector<shared::Ray> rays_from_above() {
  std::vector<shared::Ray> rays;
  for (int z = 0; z < 90; ++z) {
    for (int x = 0; x < 150; ++x) {
      shared::Ray ray{};
      ray.origin = {(static_cast<float>(x) + 0.5f) / 75.0f - 1.0f, 1.0f,
                    (static_cast<float>(z) + 0.5f) / 45.0f - 1.0f};
      ray.direction = {0, -1, 0};
      ray.t_max = 10.0f;
      rays.push_back(ray);
    }
  }
  return rays;
}

TEST_P(TracerTest, AlphaMaskIsTestedPerTexel) {
  const std::vector<shared::Ray> rays = rays_from_above();
  for (std::uint32_t wrap_s = shared::wrap_repeat; wrap_s <= shared::wrap_mirror; ++wrap_s) {
    for (std::uint32_t wrap_t = shared::wrap_repeat; wrap_t <= shared::wrap_mirror; ++wrap_t) {
      scene::Scene scene;
      const shared::Material material = masked_material(scene, wrap_s, wrap_t);
      place(scene, add_mesh(scene, quad(), material), glm::mat4(1.0f));
      const TraceResults expected = brute_force(scene, rays);
      EXPECT_GT(hit_count(expected), rays.size() / 4);
      EXPECT_LT(hit_count(expected), rays.size() * 3 / 4);
      EXPECT_EQ(disagreement(traced(scene, GetParam()).trace(rays), expected), 0.0)
          << "wrap " << wrap_s << ", " << wrap_t;
    }
  }
}

double hit_fraction(const TraceResults& results) {
  return static_cast<double>(hit_count(results)) / static_cast<double>(results.hits.size());
}

/// Material whose alpha is that of masked_material() times `factor`.
shared::Material blended_material(scene::Scene& scene, float factor) {
  shared::Material material = masked_material(scene, shared::wrap_repeat, shared::wrap_repeat);
  material.flags = shared::material_alpha_blend;
  material.base_color.w = factor;
  return material;
}

TEST_P(TracerTest, BlendedSurfacesStopRaysInProportionToAlpha) {
  const std::vector<shared::Ray> rays = rays_from_above();
  const auto count = static_cast<std::uint32_t>(rays.size());
  for (const float factor : {0.0f, 0.3f, 1.0f}) {
    scene::Scene scene, plain;
    place(scene, add_mesh(scene, quad(), blended_material(scene, factor)), glm::mat4(1.0f));
    shared::Material material = plain_material();
    material.flags = shared::material_alpha_blend;
    material.alpha_mask = shared::no_texture;
    material.base_color.w = factor;
    place(plain, add_mesh(plain, quad(), material), glm::mat4(1.0f));
    const TracedScene textured = traced(scene, GetParam()), uniform = traced(plain, GetParam());
    // Without a blending seed every blended surface stops the ray.
    EXPECT_EQ(hit_count(textured.trace(rays)), rays.size());
    EXPECT_EQ(hit_count(uniform.trace(rays)), rays.size());
    // Texels are hit equally often for uv in -1..2: 8 of 15 have alpha 220, 7 have 120.
    const double mean_alpha = (8.0 * 220.0 + 7.0 * 120.0) / 15.0 / 255.0;
    const TraceResults seen = textured.trace(rays, count, 12345);
    EXPECT_NEAR(hit_fraction(seen), factor * mean_alpha, 0.012) << "factor " << factor;
    EXPECT_NEAR(hit_fraction(uniform.trace(rays, count, 12345)), factor, 0.012);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(seen.occluded[i] != 0, seen.hits[i].instance != shared::hit_none) << i;
    }
  }
}

// Frames and layers are independent, and all tracers decide alike.
TEST_P(TracerTest, StochasticTransparencyDiffersPerFrame) {
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, quad(), blended_material(scene, 0.6f));
  place(scene, mesh, glm::mat4(1.0f));
  place(scene, mesh, glm::translate(glm::mat4(1.0f), {0.0f, -0.5f, 0.0f}));
  const std::vector<shared::Ray> rays = rays_from_above();
  const auto count = static_cast<std::uint32_t>(rays.size());
  const TracedScene subject = traced(scene, GetParam());
  const TraceResults first = subject.trace(rays, count, 1), second = subject.trace(rays, count, 2);
  double alpha = 0.0, squares = 0.0, both = 0.0, below = 0.0;
  const double share[] = {0.6 * 220.0 / 255.0, 0.6 * 120.0 / 255.0};
  for (int i = 0; i < 15; ++i) {
    const double a = share[0x4b2d >> i & 1 ? 0 : 1];
    const double stopped = 1.0 - (1.0 - a) * (1.0 - a);
    alpha += stopped / 15.0;
    squares += stopped * stopped / 15.0;
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool a = first.hits[i].instance != shared::hit_none;
    const bool b = second.hits[i].instance != shared::hit_none;
    both += a && b;
    below += a && first.hits[i].instance == 1;
  }
  EXPECT_NEAR(hit_fraction(first), alpha, 0.015);
  EXPECT_NEAR(both / count, squares, 0.015) << "frames are independent";
  EXPECT_GT(below, 0.1 * count) << "too few rays pass the upper layer and stop at the lower";
  if (!offered(protocol::TracerKind::software)) return;
  const TraceResults reference =
      traced(scene, protocol::TracerKind::software).trace(rays, count, 1);
  EXPECT_LT(disagreement(first, reference), 1e-3);
}

// Long streams dispatch several rows of workgroups: a 4K frame traces 8.3 million rays at once. Two
// rows fit the 128 MiB that lavapipe can bind.
TEST_P(TracerTest, TracesStreamsLongerThanOneDispatchRow) {
  constexpr std::uint32_t count = shared::rays_per_row + 1000;
  scene::Scene scene;
  place(scene, add_mesh(scene, quad(), plain_material()), glm::mat4(1.0f));
  std::vector<shared::Ray> rays(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    // Every third ray misses the quad.
    rays[i].origin = {i % 3 == 0 ? 5.0f : 0.3f, 1.0f + static_cast<float>(i % 1000), 0.2f};
    rays[i].direction = {0, -1, 0};
    rays[i].t_max = 1e30f;
  }
  const TraceResults results = traced(scene, GetParam()).trace(rays);
  std::size_t wrong = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool hits = i % 3 != 0;
    const float t = hits ? rays[i].origin.y : 1e30f;
    wrong += results.occluded[i] != (hits ? 1u : 0u) || std::abs(results.hits[i].t - t) > 1e-3f * t;
  }
  EXPECT_EQ(wrong, 0u);
}

TEST_P(TracerTest, TracesOnlyCountedRays) {
  const scene::Scene scene = two_level_scene(5);
  const std::vector<shared::Ray> rays = random_rays(scene, 1000, 5);
  const TracedScene subject = traced(scene, GetParam());
  for (const std::uint32_t count : {0u, 1u, 63u, 257u, 999u}) {
    const TraceResults results = subject.trace(rays, count);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(results.hits[i].t == untouched, i >= count) << i << " of " << count;
      EXPECT_EQ(results.occluded[i] == 7, i >= count) << i << " of " << count;
    }
  }
}

// Few rays are spread over many groups, and many fill them.
TEST_P(TracerTest, TracesEveryRayOfStreamsOfAnyLength) {
  constexpr std::uint32_t filling = shared::spread_groups * shared::rays_per_group;
  constexpr std::uint32_t spread = shared::spread_groups * shared::least_rays_per_group;
  scene::Scene scene;
  place(scene, add_mesh(scene, quad(), plain_material()), glm::mat4(1.0f));
  std::vector<shared::Ray> rays(filling + shared::rays_per_group + 2);
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    rays[i].origin = {0.3f, 1.0f + static_cast<float>(i % 1000), 0.2f};
    rays[i].direction = {0, -1, 0};
    rays[i].t_max = 1e30f;
  }
  const TracedScene subject = traced(scene, GetParam());
  for (const std::uint32_t count :
       {7u, 8u, 9u, 100u, spread - 1, spread, spread + 1, 2 * spread + 5, filling - 1, filling,
        filling + 1, filling + shared::rays_per_group + 1}) {
    const TraceResults results = subject.trace(rays, count);
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const float t = results.hits[i].t;
      const bool right_hit =
          i < count ? std::abs(t / rays[i].origin.y - 1.0f) < 1e-6f : t == untouched;
      wrong += !right_hit || results.occluded[i] != (i < count ? 1u : 7u);
    }
    EXPECT_EQ(wrong, 0u) << count;
  }
}

TEST_P(TracerTest, EmptySceneHasNoHits) {
  const std::vector<shared::Ray> rays = random_rays({}, 300, 6);
  EXPECT_EQ(hit_count(traced({}, GetParam()).trace(rays)), 0u);
}

TEST_P(TracerTest, EmptyIntervalsHaveNoHits) {
  const scene::Scene scene = two_level_scene(7);
  std::vector<shared::Ray> rays = random_rays(scene, 600, 7);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].t_max = i % 3 == 0 ? rays[i].t_min : i % 3 == 1 ? 0.0f : -1e30f;
  }
  const TraceResults results = traced(scene, GetParam()).trace(rays);
  EXPECT_EQ(hit_count(results), 0u);
  for (const std::uint32_t occluded : results.occluded) EXPECT_EQ(occluded, 0u);
}

TEST_P(TracerTest, IntervalIsOpenAtBothEnds) {
  scene::Scene scene;
  place(scene, add_mesh(scene, quad(), plain_material()), glm::mat4(1.0f));
  const shared::Ray down{{0.25f, 2, 0.5f}, 0.0f, {0, -1, 0}, 10.0f, 0, 0, 0, 0};
  const TracedScene subject = traced(scene, GetParam());
  const float t = subject.trace(std::vector{down}).hits[0].t;
  EXPECT_FLOAT_EQ(t, 2.0f);
  const float rounding = 1e-6f;
  std::vector<shared::Ray> rays(5, down);
  rays[0].t_max = t;
  rays[1].t_min = t;
  rays[2].t_min = t - rounding;
  rays[3].t_max = t + rounding;
  rays[4].origin.y = 0.0f;  // starts on the surface
  const TraceResults results = subject.trace(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool within = i == 2 || i == 3;
    EXPECT_EQ(results.hits[i].instance == 0, within) << "ray " << i;
    EXPECT_EQ(results.occluded[i], within ? 1u : 0u) << "ray " << i;
  }
}

TEST_P(TracerTest, FlatInstancesAndNaNVerticesHaveNoHits) {
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, quad(), plain_material());
  place(scene, mesh, glm::scale(glm::mat4(1.0f), glm::vec3(1, 1, 0)));
  scene::Mesh torn = quad();
  torn.vertices[1].position.y = std::numeric_limits<float>::infinity();
  torn.vertices[3].position.x = std::numeric_limits<float>::quiet_NaN();
  place(scene, add_mesh(scene, torn, plain_material()), glm::mat4(1.0f));
  scene.bounds = {glm::vec3(-1.0f), glm::vec3(1.0f)};
  EXPECT_EQ(hit_count(traced(scene, GetParam()).trace(random_rays(scene, 500, 9))), 0u);
}

TEST_P(TracerTest, HitsBothFacesOfMirroredInstances) {
  scene::Scene scene;
  const std::uint32_t mesh = add_mesh(scene, quad(), plain_material());
  place(scene, mesh, glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1)));
  std::vector<shared::Ray> rays(2);
  rays[0] = {{0.25f, 2, 0.5f}, 0.0f, {0, -1, 0}, 10.0f, 0, 0, 0, 0};
  rays[1] = {{0.25f, -2, 0.5f}, 0.0f, {0, 1, 0}, 10.0f, 0, 0, 0, 0};
  const TraceResults results = traced(scene, GetParam()).trace(rays);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(results.hits[i].instance, 0u);
    EXPECT_FLOAT_EQ(results.hits[i].t, 2.0f);
    EXPECT_EQ(results.occluded[i], 1u);
  }
}

/// A closed mesh off the origin, and rays from inside it exactly toward its edges or its vertices.
struct ClosedMesh {
  ClosedMesh() {
    world = glm::translate(world, {13.1f, -7.7f, 31.3f});
    world = glm::rotate(world, 0.7f, glm::normalize(glm::vec3(1, 2, 3)));
    world = glm::scale(world, {1.3f, 0.9f, 1.1f});
    place(scene, add_mesh(scene, sphere(24), plain_material()), world);
  }

  std::vector<shared::Ray> rays(bool at_vertices, std::size_t count) const {
    const scene::Mesh& mesh = scene.meshes[0];
    Random random(10);
    std::vector<shared::Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t triangle = random() % (mesh.indices.size() / 3);
      const auto corner = [&](std::size_t c) {
        const std::uint32_t index = mesh.indices[3 * triangle + c % 3];
        return glm::vec3(world * glm::vec4(mesh.vertices[index].position, 1.0f));
      };
      const float share = at_vertices ? 0.0f : uniform(random, 0.0f, 1.0f);
      const glm::vec3 target = glm::mix(corner(i), corner(i + 1), share);
      const glm::vec3 inside = glm::vec3(world * glm::vec4(uniform_vector(random, 0.5f), 1.0f));
      rays.push_back({inside, 0.0f, glm::normalize(target - inside), 1e6f, 0, 0, 0, 0});
    }
    return rays;
  }

  scene::Scene scene;
  glm::mat4 world{1.0f};
};

TEST_P(TracerTest, ClosedMeshIsWatertightAtEdges) {
  const ClosedMesh mesh;
  const std::vector<shared::Ray> rays = mesh.rays(false, 100'000);
  const TracedScene subject = traced(mesh.scene, GetParam());
  for (const RayKind kind : {RayKind::path, RayKind::camera}) {
    const TraceResults results = subject.trace(rays, kind);
    EXPECT_EQ(hit_count(results), rays.size());
    EXPECT_EQ(std::ranges::count(results.occluded, 0u), 0);
  }
}

// Embree's robust mode decides alike on both sides of an edge, but each edge at a vertex for
// itself: of the rays that are aimed at vertices one in a thousand passes.
TEST_P(TracerTest, ClosedMeshIsNearlyWatertightAtVertices) {
  const ClosedMesh mesh;
  const std::vector<shared::Ray> rays = mesh.rays(true, 20'000);
  const TraceResults results = traced(mesh.scene, GetParam()).trace(rays);
  const std::size_t most = GetParam() == protocol::TracerKind::embree ? rays.size() / 500 : 0;
  EXPECT_GE(hit_count(results), rays.size() - most);
  EXPECT_LE(std::ranges::count(results.occluded, 0u), static_cast<std::ptrdiff_t>(most));
}

// Those that a tracer need not find watertight surfaces with.
TEST_P(TracerTest, EveryKindOfRayHitsTheSame) {
  const scene::Scene scene = two_level_scene(11);
  const std::vector<shared::Ray> rays = random_rays(scene, 5000, 11);
  const TracedScene subject = traced(scene, GetParam());
  const TraceResults expected = subject.trace(rays);
  for (const RayKind kind : {RayKind::camera, RayKind::shadow, RayKind::ambient,
                             RayKind::reflection, RayKind::hit_shadow}) {
    EXPECT_LT(disagreement(subject.trace(rays, kind), expected), 1e-3) << static_cast<int>(kind);
  }
}

INSTANTIATE_TEST_SUITE_P(, TracerTest, testing::ValuesIn(all_tracers), test_name);

class AssetTest : public TracersTest {
 protected:
  static void expect_agreement(const char* file) {
    const char* assets = std::getenv("HELIOGRAPH_TEST_ASSETS");
    if (!assets) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
    const scene::Scene scene = scene::import_gltf(std::filesystem::path(assets) / file);
    const bool cpu = rig_->device.is_cpu();
    const std::vector<shared::Ray> rays = random_rays(scene, cpu ? 200'000 : 2'000'000, 8);
    const TraceResults expected = traced(scene, protocol::TracerKind::software).trace(rays);
    EXPECT_GT(hit_count(expected), rays.size() / 50);
    for (const auto& [kind, tracer] : rig_->tracers) {
      const std::string name(protocol::enum_name(kind));
      const TracedScene subject = traced(scene, kind);
      Tracing tracing = subject.tracing(rays.size());
      const double share = disagreement(tracing.run(rays), expected);
      std::printf("%s: disagrees with software on %.6f of %zu rays; %s\n", name.c_str(), share,
                  rays.size(), tracing.least_times(cpu ? 1 : 20).c_str());
      EXPECT_LT(share, 1e-3) << name;
    }
  }
};

TEST_F(TracersTest, UnsupportedTracerIsRejected) {
  for (const protocol::TracerKind kind : all_tracers) {
    if (offered(kind)) continue;
    EXPECT_THROW(make_tracer(kind, rig_->device), gpu::GpuError) << protocol::enum_name(kind);
  }
}

TEST_F(AssetTest, TracersAgreeOnDamagedHelmet) {
  expect_agreement("gltf/DamagedHelmet.glb");
}

TEST_F(AssetTest, TracersAgreeOnAtrium) {
  expect_agreement("standins/glossy_sponza_1.glb");
}

}  // namespace
}  // namespace heliograph::tracing
