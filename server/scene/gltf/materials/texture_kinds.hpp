#pragma once

#include <span>
#include <string_view>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// A texture slot that every material may have.
struct TextureKind {
  std::string_view name;  // as clients know it
  bool srgb = false;      // holds colours, not data
  /// The object of a document's material that has the textureInfo: the material itself where it is
  /// empty, "pbrMetallicRoughness", or an extension.
  const char* owner = "";
  const char* member = "";  // of the owner
  /// One of both.
  shared::TextureSlot shared::Material::*base = nullptr;
  shared::TextureSlot MaterialLayers::*layer = nullptr;

  bool of_extension() const { return layer != nullptr; }
  shared::TextureSlot& of(shared::Material& material, MaterialLayers& layers) const {
    return layer ? layers.*layer : material.*base;
  }
  const shared::TextureSlot& of(const shared::Material& material,
                                const MaterialLayers& layers) const {
    return layer ? layers.*layer : material.*base;
  }
};

/// All of them; those of the base material first.
std::span<const TextureKind> texture_kinds();
/// Null where there is none of this name.
const TextureKind* find_texture_kind(std::string_view name);

}  // namespace heliograph::scene
