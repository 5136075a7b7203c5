#pragma once

#include <tiny_gltf.h>

#include <vector>

namespace heliograph::scene {

/// Per buffer view: whether it is the file of an image and nothing else.
std::vector<bool> find_image_views(const tinygltf::Model& model);

}  // namespace heliograph::scene
