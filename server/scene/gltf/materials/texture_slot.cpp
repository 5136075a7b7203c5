#include "scene/gltf/materials/texture_slot.hpp"

#include <cmath>

namespace heliograph::scene {
namespace {

// KHR_texture_transform: translation * rotation * scale; the rotation is counter-clockwise with v
// pointing down. The sample matrix in the extension's text rotates the other way; its test model
// and the implementations agree on this one (github.com/KhronosGroup/glTF/issues/1563).
void apply_transform(const JsonValue& transform, shared::TextureSlot& slot) {
  const auto offset = transform.numbers<2>("offset", {0.0f, 0.0f});
  const auto scale = transform.numbers<2>("scale", {1.0f, 1.0f});
  const float rotation = transform.number("rotation", 0.0f);
  const float cosine = std::cos(rotation);
  const float sine = std::sin(rotation);
  slot.transform_row0 = {cosine * scale[0], sine * scale[1], offset[0], 0.0f};
  slot.transform_row1 = {-sine * scale[0], cosine * scale[1], offset[1], 0.0f};
}

}  // namespace

shared::TextureSlot read_texture_slot(const JsonValue& json, bool srgb, TextureTable& textures,
                                      Warnings& warnings) {
  shared::TextureSlot slot = no_texture_slot();
  const std::uint32_t texture = json.required_index("index", textures.size(), "textures");
  std::uint64_t uv_set = json.integer("texCoord", 0);
  if (const auto transform = json.object("extensions", "KHR_texture_transform")) {
    apply_transform(*transform, slot);
    uv_set = transform->integer("texCoord", uv_set);
  }
  if (uv_set > 1) {
    warnings.add(json.path() + ".texCoord: only the sets 0 and 1 are kept, 0 is used");
    uv_set = 0;
  }
  slot.uv_set = static_cast<std::uint32_t>(uv_set);
  slot.texture = textures.use(texture, srgb);
  if (slot.texture == shared::no_texture) {
    warnings.add("textures[" + std::to_string(texture) +
                 "] has no PNG, JPEG or WebP image and was left out");
  }
  return slot;
}

}  // namespace heliograph::scene
