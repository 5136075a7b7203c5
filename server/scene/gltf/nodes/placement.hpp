#pragma once

#include <stop_token>
#include <vector>

#include "scene/byte_budget.hpp"
#include "scene/gltf/geometry/primitives.hpp"
#include "scene/gltf/nodes/nodes.hpp"
#include "scene/import_limits.hpp"
#include "scene/scene.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// What nodes place in the world, as in the document.
struct PlacedObjects {
  const PrimitiveTable& primitives;
  const std::vector<Light>& lights;
  const std::vector<Camera>& cameras;
};

struct PlacementContext {
  const ImportLimits& limits;
  ByteBudget& budget;
  Warnings& warnings;
  const std::stop_token& stop;
};

/// Adds instances, deformations, lights and cameras of all nodes to a scene that has its meshes,
/// shapes, skins, clips and nodes, and computes its bounds. Deforming meshes get a mesh for each of
/// their instances, for which the budget is charged.
/// @throws ImportError where a limit is exceeded or something lies beyond the range of coordinates;
/// LoadCancelled
void place_objects(Scene& scene, const NodeTable& nodes, const PlacedObjects& objects,
                   const PlacementContext& context);

}  // namespace heliograph::scene
