#pragma once

#include <stop_token>
#include <vector>

#include "scene/gltf/export/added_image.hpp"
#include "scene/gltf/export/editable_document.hpp"
#include "scene/import_limits.hpp"
#include "scene/scene.hpp"
#include "scene/source_file.hpp"

namespace heliograph::scene {

struct TextureExport {
  std::vector<AddedImage> images;
  std::vector<SourceFile> files;  // that were read, as they were before
};

/// Writes the textures that the scene has in place of the document's: slots refer to new images, or
/// lose their texture. What glTF has no place for is told in warnings.
/// @throws ImportError where a file cannot be read; LoadCancelled
TextureExport export_textures(EditableDocument& document, const Scene& scene,
                              const ImportLimits& limits, const std::stop_token& stop);

}  // namespace heliograph::scene
