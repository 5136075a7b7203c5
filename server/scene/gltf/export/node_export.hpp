#pragma once

#include <cstdint>
#include <span>

#include "scene/gltf/export/light_export.hpp"

namespace heliograph::scene {

/// Hides these nodes of the scene and those below them with KHR_node_visibility. It hides lights,
/// too: a node with lights below stays, and those below it are hidden one by one. A mesh that stays
/// visible is told in a warning.
void export_hidden(EditableDocument& document, const Scene& scene, DocumentNodes nodes,
                   std::span<const std::uint32_t> hidden);

}  // namespace heliograph::scene
