#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>

#include "gpu/memory/image.hpp"
#include "render/resources/host_tables.hpp"
#include "render/resources/programs.hpp"
#include "scene/environment.hpp"

namespace heliograph::render {

/// An environment as passes look it up (paper section 3, stage 1).
struct EnvironmentMaps {
  gpu::Image map;          // equirectangular, linear radiance
  gpu::Image prefiltered;  // cube, GGX lobes; roughness rises linearly with the level
  gpu::Buffer cells;       // EnvironmentCell, read as texels of four words
  std::array<glm::vec4, 9> irradiance{};
  std::shared_ptr<const kernels::Environment> host = nullptr;  // on devices that are processors
};

/// The map as it is, for sampling.
gpu::Image upload_environment(const gpu::Device& device, const scene::Environment& environment);

/// Runs once per environment. Split-sum first half and spherical harmonics.
EnvironmentMaps prefilter_environment(const gpu::Device& device, const Programs& programs,
                                      const scene::Environment& environment);

/// The split-sum's second half over (n.v, roughness): scale and bias of F0. Once per device.
gpu::Image make_split_sum_table(const gpu::Device& device, const Programs& programs);

/// What white sheen gives back of light from everywhere, over (n.v, roughness). Once per device.
gpu::Image make_sheen_table(const gpu::Device& device, const Programs& programs);

/// Linear filtering; repeats around the equator where `wrap_u`, clamps otherwise.
gpu::Sampler make_environment_sampler(const gpu::Device& device, bool wrap_u);

}  // namespace heliograph::render
