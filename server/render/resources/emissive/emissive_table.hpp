#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/resources/emissive/emission_means.hpp"
#include "scene/scene.hpp"
#include "shaders/shared/emissive.h"

namespace heliograph::render {

/// The emissive triangles of a scene as shaders/lib/lighting/emissive_lights.glsl draws them: by
/// their power, in one look-up.
struct EmissiveTable {
  shared::EmissiveHeader header{};
  std::vector<shared::EmissiveTriangle> triangles;
  std::vector<std::uint32_t> first;  // by instance: its first triangle's entry, or no_emissive
};

/// What the table is made of.
struct EmissiveScene {
  const scene::Scene& scene;
  std::span<const shared::Material> materials;  // the scene's, or others in their place
  const EmissionMeans& means;
  std::span<const glm::mat4> worlds;  // mesh -> world, by instance
};

/// Entries of a table, at most: 40 MiB.
inline constexpr std::size_t most_emissive = std::size_t{1} << 21;

/// All triangles of every instance that shines, in order. A triangle's power is its area times the
/// luminance of its mean emission times pi, twice that where both sides shine. Instances of unlit
/// materials are no lights: they show their colour whatever lies around them. Where there are more
/// than `most` triangles, instances with the least power for each are left out: they are lit up by
/// rays that hit them alone.
EmissiveTable make_emissive_table(const EmissiveScene& from, std::size_t most = most_emissive);

/// How many triangles can ever be in the table, however instances are scaled: at most `most`.
std::size_t emissive_capacity(const scene::Scene& scene,
                              std::span<const shared::Material> materials,
                              std::size_t most = most_emissive);

/// Whether the tables of both are the same: emission and the sides that show it.
bool same_emission(std::span<const shared::Material> a, std::span<const shared::Material> b);

/// By how much a matrix enlarges areas, the mean over all orientations, about.
float area_scale(const glm::mat4& world);

}  // namespace heliograph::render
