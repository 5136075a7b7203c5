// The only source with tinygltf's code: without its image decoders, and without its access to
// files. It does not include all that it uses, so that the order matters.
// clang-format off
#include <fstream>
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
// clang-format on

#include "scene/gltf/export/glb_writer.hpp"

namespace heliograph::scene {

void write_glb(std::ostream& out, const std::string& document,
               const std::vector<std::uint8_t>& binary) {
  tinygltf::WriteBinaryGltfStream(out, document, binary);
}

}  // namespace heliograph::scene
