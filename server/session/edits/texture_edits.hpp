#pragma once

#include <string>
#include <vector>

#include "protocol/messages/edit_messages.hpp"
#include "protocol/messages/texture_messages.hpp"
#include "protocol/result.hpp"
#include "scene/scene.hpp"
#include "session/library/scene_catalogue.hpp"

// Textures of materials in place of those of the scene's file. They are part of the scene itself,
// which is imported with them.

namespace heliograph::session {

/// In the order of `canonical`.
using TextureOverrides = std::vector<scene::TextureOverride>;

/// The same in the one order that all lists of them have, so that equal ones are equal.
TextureOverrides canonical(TextureOverrides textures);
/// What a scene was imported with.
TextureOverrides overrides_of(const scene::Scene& scene);

/// The uploaded images that may take the place of textures: every PNG, JPEG, WebP and KTX2 file
/// below the roots, named like scenes.
std::vector<CatalogueEntry> list_images(const SceneCatalogue& catalogue);
/// All slots with a texture in the file, or that are changed.
protocol::TextureList list_textures(const scene::Scene& scene);
protocol::TextureInfo describe_texture(const scene::Scene& scene, const std::string& material,
                                       const std::string& slot);
/// @return an error of "material" or "slot" where the scene has none of this name
protocol::Result<void> check_slot(const scene::Scene& scene, const std::string& material,
                                  const std::string& slot);

/// Of all entries of a document; errors name them below "edits".
protocol::Result<void> check_slots(const scene::Scene& scene,
                                   const protocol::EditDocument& document);

/// `textures` with the change; the scene has its slot.
protocol::Result<TextureOverrides> with_change(TextureOverrides textures,
                                               const protocol::TextureSet& change,
                                               const SceneCatalogue& images);
/// The part of a document that is about textures.
void describe_textures(const scene::Scene& scene, protocol::EditDocument& document);
/// Whether a scene has just the textures that a document asks for. Their images are compared by
/// name: what is shown needs no file, which may be gone.
bool has_textures(const scene::Scene& scene, const protocol::EditDocument& document);
/// What a document asks for. Whether the scene has the slots is not known before it is imported.
/// @return an error that names the entry below "edits"
protocol::Result<TextureOverrides> overrides_of(const protocol::EditDocument& document,
                                                const SceneCatalogue& images);

}  // namespace heliograph::session
