#pragma once

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/materials/textures.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// An object of KHR_texture_transform.
TextureTransform read_texture_transform(const ExtensionValue& value);

/// The parts of a textureInfo: see below.
shared::TextureSlot read_texture_slot(int texture, int uv_set,
                                      const std::optional<ExtensionValue>& transform,
                                      const std::string& path, bool srgb, TextureTable& textures,
                                      Warnings& warnings);

/// A textureInfo of a material: the texture registered in `textures` as color (sRGB) or data, its
/// texCoord set and its transform. An empty slot where the model has no texture.
template <typename TextureInfo>
shared::TextureSlot read_texture_slot(const TextureInfo& info, const std::string& path, bool srgb,
                                      TextureTable& textures, Warnings& warnings) {
  return read_texture_slot(info.index, info.texCoord,
                           find_extension(info.extensions, "KHR_texture_transform", path), path,
                           srgb, textures, warnings);
}

/// The texCoord set and the transform of a textureInfo of an extension, without its texture.
shared::TextureSlot read_uv(const ExtensionValue& info, Warnings& warnings);

/// The same of an extension.
shared::TextureSlot read_texture_slot(const ExtensionValue& info, bool srgb, TextureTable& textures,
                                      Warnings& warnings);

}  // namespace heliograph::scene
