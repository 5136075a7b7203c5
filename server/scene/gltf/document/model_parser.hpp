#pragma once

#include <tiny_gltf.h>

#include "scene/gltf/schema/document_check.hpp"

namespace heliograph::scene {

/// Lets tinygltf parse a document that has passed the check. It opens no files and decodes no
/// images: buffers are stand-ins, images keep their places.
/// The model has one buffer view more than the document: accessors without one refer to it.
/// @throws ImportError
tinygltf::Model parse_model(const CheckedDocument& document);

}  // namespace heliograph::scene
