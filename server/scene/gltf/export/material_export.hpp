#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "scene/gltf/export/editable_document.hpp"
#include "scene/gltf/export/scene_changes.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// A material of the scene in the document, by its index; one that primitives without a material
/// have is added where the document lacks it.
nlohmann::json& material_of(EditableDocument& document, std::size_t index);

/// Makes the materials of the variant that the scene shows those of the primitives.
void export_variant(EditableDocument& document, const Scene& scene);

/// Writes the factors of materials that differ from the scene's, of their extensions as well. What
/// glTF has no place for is told in warnings.
void export_materials(EditableDocument& document, const Scene& scene, const SceneChanges& changes);

}  // namespace heliograph::scene
