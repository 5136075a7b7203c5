#include "scene/gltf/materials/texture_slot.hpp"

#include <cmath>

namespace heliograph::scene {
namespace {

// KHR_texture_transform: translation * rotation * scale; the rotation is counter-clockwise with v
// pointing down. The sample matrix in the extension's text rotates the other way; its test model
// and the implementations agree on this one (github.com/KhronosGroup/glTF/issues/1563).
void apply_transform(const ExtensionValue& transform, shared::TextureSlot& slot) {
  const auto offset = transform.numbers<2>("offset", {0.0f, 0.0f});
  const auto scale = transform.numbers<2>("scale", {1.0f, 1.0f});
  const float rotation = transform.number("rotation", 0.0f);
  const float cosine = std::cos(rotation);
  const float sine = std::sin(rotation);
  slot.transform_row0 = {cosine * scale[0], sine * scale[1], offset[0], 0.0f};
  slot.transform_row1 = {-sine * scale[0], cosine * scale[1], offset[1], 0.0f};
}

shared::TextureSlot uv_slot(std::uint64_t uv_set, const std::optional<ExtensionValue>& transform,
                            const std::string& path, Warnings& warnings) {
  shared::TextureSlot slot = no_texture_slot();
  if (transform) {
    apply_transform(*transform, slot);
    uv_set = transform->integer("texCoord").value_or(uv_set);
  }
  if (uv_set > 1) {
    warnings.add(path + ".texCoord: only the sets 0 and 1 are kept, 0 is used");
    uv_set = 0;
  }
  slot.uv_set = static_cast<std::uint32_t>(uv_set);
  return slot;
}

std::optional<ExtensionValue> transform_of(const ExtensionValue& info) {
  const auto extensions = info.object("extensions");
  return extensions ? extensions->object("KHR_texture_transform") : std::nullopt;
}

}  // namespace

shared::TextureSlot read_texture_slot(int texture, int uv_set,
                                      const std::optional<ExtensionValue>& transform,
                                      const std::string& path, bool srgb, TextureTable& textures,
                                      Warnings& warnings) {
  const auto index = to_index(texture);
  if (!index) return no_texture_slot();
  shared::TextureSlot slot = uv_slot(static_cast<std::uint64_t>(uv_set), transform, path, warnings);
  slot.texture = textures.use(*index, srgb);
  if (slot.texture == shared::no_texture) {
    warnings.add(item_path("", "textures", *index) +
                 " has no image that can be read and was left out");
  }
  return slot;
}

shared::TextureSlot read_uv(const ExtensionValue& info, Warnings& warnings) {
  return uv_slot(info.integer("texCoord").value_or(0), transform_of(info), info.path(), warnings);
}

shared::TextureSlot read_texture_slot(const ExtensionValue& info, bool srgb, TextureTable& textures,
                                      Warnings& warnings) {
  return read_texture_slot(static_cast<int>(*info.index("index")),
                           static_cast<int>(info.index("texCoord").value_or(0)), transform_of(info),
                           info.path(), srgb, textures, warnings);
}

}  // namespace heliograph::scene
