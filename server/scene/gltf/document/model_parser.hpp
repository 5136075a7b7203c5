#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "scene/gltf/schema/document_check.hpp"

namespace heliograph::scene {

/// Reads the data of a buffer: exactly as many bytes as the document says. @throws ImportError
using BufferReader = std::function<std::vector<std::uint8_t>(std::size_t buffer)>;

/// Lets tinygltf parse a document that has passed the check. It opens no files and decodes no
/// images: buffers come from `read`, images keep their places.
/// The model has one buffer view more than the document: accessors without one refer to it.
/// @throws ImportError
tinygltf::Model parse_model(const CheckedDocument& document, const BufferReader& read);

}  // namespace heliograph::scene
