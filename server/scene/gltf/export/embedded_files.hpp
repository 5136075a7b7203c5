#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/export/added_image.hpp"
#include "scene/gltf/export/editable_document.hpp"

namespace heliograph::scene {

/// The MIME type of an image by its first bytes; those of glTF and its extensions.
std::string_view mime_type_of(std::span<const std::uint8_t> file);

/// Joins the buffers of a file and the files of its images, as they are, into the binary chunk of a
/// .glb, with those of `added` images of the document, and lets the document refer to it. Images
/// that do not exist keep their address, with a warning.
/// @throws ImportError where there are more bytes than the limit on files
std::vector<std::uint8_t> embed_files(GltfFile& file, EditableDocument& document,
                                      std::span<const AddedImage> added,
                                      const ImportLimits& limits);

}  // namespace heliograph::scene
