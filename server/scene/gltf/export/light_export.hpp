#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/gltf/export/editable_document.hpp"
#include "scene/gltf/export/scene_changes.hpp"

namespace heliograph::scene {

/// By node of a scene: its index in the document; nothing where it was made by the importer.
using DocumentNodes = std::span<const std::optional<std::uint32_t>>;

/// Writes the lights that differ from the scene's, and those that are added. Removed ones leave
/// their nodes behind; those that are off have the intensity 0. A light that is moved takes its
/// node along where the node has nothing else, and becomes a child of it otherwise. Area lights
/// stay in "extras", which other programs ignore: told in warnings.
void export_lights(EditableDocument& document, const Scene& scene, DocumentNodes nodes,
                   std::span<const LightChange> lights);

}  // namespace heliograph::scene
