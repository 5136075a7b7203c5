#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "scene/scene.hpp"

namespace heliograph::tracing {

/// Alpha test tables of a scene for shaders that traverse the driver's acceleration structures: the
/// buffers of shaders/lib/rays/driver_hierarchy.glsl.
struct MaskTables {
  /// @throws gpu::GpuError when the device cannot bind tables of that size
  MaskTables(const gpu::Device& device, const scene::Scene& scene);

  gpu::Buffer mask_of_instance;  // uint, by instance of the scene
  gpu::Buffer masks;             // shared::RayMask
  gpu::Buffer uvs;               // three vec2 per triangle of a masked mesh
};

}  // namespace heliograph::tracing
