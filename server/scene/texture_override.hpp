#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace heliograph::scene {

/// A texture of a material in place of the one that the file has.
struct TextureOverride {
  std::string material;         // one of material_labels
  std::string slot;             // the name of one of texture_kinds
  std::string name;             // of the image, for clients and errors
  std::filesystem::path image;  // PNG, JPEG, WebP or KTX2; empty: the slot has no texture
  bool operator==(const TextureOverride&) const = default;
};

/// What a slot has, and what it had in the file.
struct ReplacedTexture {
  std::uint32_t material = 0;
  TextureOverride by;
  std::optional<std::string> file_image;  // a name, perhaps empty; nothing: there was no texture
  std::uint32_t file_width = 0;           // in pixels; 0: the image cannot be read
  std::uint32_t file_height = 0;
};

/// Unique names of `count` materials, in their order: one without a name gets its number.
std::vector<std::string> material_labels(const std::vector<std::string>& names, std::size_t count);

}  // namespace heliograph::scene
