#include "scene/gltf/materials/texture_slot.hpp"

namespace heliograph::scene {
namespace {

shared::TextureSlot uv_slot(std::uint64_t uv_set, const std::optional<ExtensionValue>& transform,
                            const std::string& path, Warnings& warnings) {
  shared::TextureSlot slot = no_texture_slot();
  if (transform) {
    read_texture_transform(*transform).apply(slot);
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

TextureTransform read_texture_transform(const ExtensionValue& value) {
  const auto offset = value.numbers<2>("offset", {0.0f, 0.0f});
  const auto scale = value.numbers<2>("scale", {1.0f, 1.0f});
  return {.offset = {offset[0], offset[1]},
          .rotation = value.number("rotation", 0.0f),
          .scale = {scale[0], scale[1]}};
}

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
