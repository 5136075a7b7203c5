#pragma once

#include <cstdint>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/export/editable_document.hpp"

namespace heliograph::scene {

/// Joins the buffers of a file and the files of its images, as they are, into the binary chunk of a
/// .glb, and lets the document refer to it. Images that do not exist keep their address, with a
/// warning. @throws ImportError where there are more bytes than the limit on files
std::vector<std::uint8_t> embed_files(GltfFile& file, EditableDocument& document,
                                      const ImportLimits& limits);

}  // namespace heliograph::scene
