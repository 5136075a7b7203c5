#pragma once

#include <map>
#include <string>

#include "cli/compare/image_difference.hpp"
#include "cli/options.hpp"

namespace heliograph::cli {

/// The images of one side by their names: one, or one of each camera.
using NamedImages = std::map<std::string, ComparedImage>;

/// Renders a .glb or .gltf file as `options` say, asks the server of an http:// or https:// address
/// for its view, or reads an image file. @throws std::runtime_error naming the source
NamedImages images_of(const std::string& source, const RenderOptions& options,
                      const CompareOptions& compared);

}  // namespace heliograph::cli
