#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>

#include "scene/byte_budget.hpp"
#include "scene/environment.hpp"
#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/materials/images.hpp"
#include "scene/import_limits.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// What reading a light from around a scene takes from its import.
struct ImageLightContext {
  ImageFiles& images;
  const ImportLimits& limits;
  TexelBudget& texels;  // of its faces
  ByteBudget& bytes;    // of the environment
  Warnings& warnings;
  const std::stop_token& stop;
};

/// The light of EXT_lights_image_based around the scene of that index, from the largest mip of its
/// cube; null where the scene has none, or no face of it can be read.
/// @throws ImportError when a limit is exceeded, or with strict assets an image is missing, damaged
/// or not as large as the light says; LoadCancelled
std::shared_ptr<const Environment> read_image_light(const tinygltf::Model& model,
                                                    std::optional<std::uint32_t> scene,
                                                    const ImageLightContext& context);

}  // namespace heliograph::scene
