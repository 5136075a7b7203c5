#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "scene/scene.hpp"

namespace heliograph::tracing {

/// Where rays pass through a scene's masked meshes, for shaders that walk the driver's hierarchies:
/// the buffers of shaders/lib/rays/driver_hierarchy.glsl.
struct MaskTables {
  /// @throws gpu::GpuError when the device cannot bind tables of that size
  MaskTables(const gpu::Device& device, const scene::Scene& scene);

  gpu::Buffer mask_of_instance;  // uint, by instance of the scene
  gpu::Buffer masks;             // shared::RayMask
  gpu::Buffer uvs;               // three vec2 per triangle of a masked mesh
};

}  // namespace heliograph::tracing
