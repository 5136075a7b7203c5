#include <gtest/gtest.h>

#include <vector>

#include "tests/gpu/tracing/tracer_rig.hpp"

namespace heliograph::tracing {
namespace {

/// Of every four instances, a clip moves three.
bool stays(std::uint32_t instance) {
  return instance % 4 == 3;
}

/// Moves every third instance that does not stay, scales one of them flat, and deforms the meshes.
std::vector<std::uint32_t> move_and_deform(scene::Scene& scene, Random& random,
                                           std::uint32_t step) {
  std::vector<std::uint32_t> moved;
  for (std::uint32_t i = step % 3; i < scene.instances.size(); i += 3) {
    if (stays(i)) continue;
    glm::mat4& world = scene.nodes[scene.instances[i].node].world;
    world = glm::translate(glm::mat4(1.0f), uniform_vector(random, 4.0f));
    world = glm::rotate(world, uniform(random, 0.0f, 6.0f), glm::vec3(0.6f, 0.0f, 0.8f));
    moved.push_back(i);
  }
  glm::mat4& flat = scene.nodes[scene.instances[moved.front()].node].world;
  flat = glm::scale(flat, glm::vec3(1, 1, 0));
  for (const scene::Deformation& deformation : scene.deformations) {
    scene::Mesh& mesh = scene.meshes[deformation.mesh];
    mesh.bounds = {};
    for (shared::Vertex& vertex : mesh.vertices) {
      vertex.position += uniform_vector(random, 0.3f);
      mesh.bounds.include(vertex.position);
    }
  }
  return moved;
}

class MovingTracerTest : public TracerTest {};

TEST_P(MovingTracerTest, MatchesBruteForceForMovingAndDeformedMeshes) {
  scene::Scene scene = two_level_scene(10);
  scene.clips.push_back(clip_of(scene, [](std::uint32_t i) { return !stays(i); }));
  constexpr std::uint32_t a_sphere = 1, a_masked_quad = 4;
  for (const std::uint32_t mesh : {a_sphere, a_masked_quad}) {
    scene.deformations.push_back({.mesh = mesh, .shape = 0, .node = 0, .skin = {}});
  }
  const TracedScene static_scene = traced(scene, GetParam());
  const auto structure = static_scene.moving(scene);
  const std::vector<shared::Ray> rays = random_rays(scene, 3000, 10);
  Tracing tracing(rig_->device, *rig_->tracers.at(GetParam()), *structure, rays.size());
  const TraceResults at_start = brute_force(scene, rays);
  EXPECT_LT(disagreement(tracing.run(rays), at_start), 1e-3) << "before any motion";
  Random random(10);
  for (std::uint32_t step = 0; step < 4; ++step) {
    const std::vector<std::uint32_t> moved = move_and_deform(scene, random, step);
    std::vector<glm::mat4> worlds;
    for (const scene::Instance& instance : scene.instances) {
      worlds.push_back(scene.nodes[instance.node].world);
    }
    std::vector<Movement::Mesh> deformed;
    for (const scene::Deformation& deformation : scene.deformations) {
      const scene::Mesh& mesh = scene.meshes[deformation.mesh];
      deformed.push_back({deformation.mesh, mesh.vertices, mesh.bounds});
    }
    structure->update({worlds, moved, deformed});
    const TraceResults expected = brute_force(scene, rays);
    EXPECT_GT(disagreement(expected, at_start), 0.1) << "scene hardly moves";
    EXPECT_LT(disagreement(tracing.run(rays), expected), 1e-3) << "step " << step;
  }
  EXPECT_LT(disagreement(static_scene.trace(rays), at_start), 1e-3)
      << "the static scene must not change";
}

INSTANTIATE_TEST_SUITE_P(, MovingTracerTest, testing::ValuesIn(all_tracers), test_name);

}  // namespace
}  // namespace heliograph::tracing
