#pragma once

#include <cstdint>
#include <vector>

#include "scenes/generator/gltf/document.hpp"

namespace heliograph::scenes {

/// The bytes of a GLB file: glTF 2.0 with KHR_lights_punctual, PNG maps of `texture_size` pixels
/// embedded. The same document gives the same bytes.
std::vector<std::uint8_t> encode_glb(const Document& document, int texture_size);

}  // namespace heliograph::scenes
