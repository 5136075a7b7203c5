#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"

// Messages about the textures of materials, and the uploaded images that can take their place.

namespace heliograph::protocol {

struct ImageFile {
  std::string name;
  std::uint64_t bytes = 0;
  bool uploaded = false;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &ImageFile::name, "Name for textures.set."),
        field("bytes", &ImageFile::bytes, "Size of the file.").unit("bytes"),
        field("uploaded", &ImageFile::uploaded,
              "Whether it was uploaded: then DELETE /api/v1/images/NAME deletes it."),
    };
  }
  bool operator==(const ImageFile&) const = default;
};

struct ImageList {
  std::vector<ImageFile> images;

  static constexpr auto fields() {
    return std::tuple{
        field("images", &ImageList::images, "The images in the folder of uploads, by name."),
    };
  }
  bool operator==(const ImageList&) const = default;
};

/// A texture slot of a material.
struct TextureInfo {
  std::string material;
  std::string slot;
  std::optional<std::string> file_image;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::optional<std::string> image;
  bool removed = false;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &TextureInfo::material, "A name from materials.list."),
        field("slot", &TextureInfo::slot, "The slot, one of textures.list."),
        field("file_image", &TextureInfo::file_image,
              "Name of the image that the scene file has there, perhaps empty; absent: it has "
              "no texture."),
        field("width", &TextureInfo::width, "Width of that image; 0: it cannot be read.")
            .unit("pixels"),
        field("height", &TextureInfo::height, "Height of that image; 0: it cannot be read.")
            .unit("pixels"),
        field("image", &TextureInfo::image,
              "The image of images.list that takes its place; absent: none."),
        field("removed", &TextureInfo::removed, "Whether the slot's texture is removed."),
    };
  }
  bool operator==(const TextureInfo&) const = default;
};

struct TextureList {
  std::vector<std::string> slots;
  std::vector<TextureInfo> textures;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("slots", &TextureList::slots, "The slots that every material has."),
        field("textures", &TextureList::textures,
              "Slots with a texture in the scene file, or that are changed, by material."),
        field("rev", &TextureList::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const TextureList&) const = default;
};

struct TextureSet {
  static constexpr bool strict = true;
  std::string material;
  std::string slot;
  Change<std::string> image;
  bool removed = false;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &TextureSet::material, "A name from materials.list.")
            .length(1, max_node_name),
        field("slot", &TextureSet::slot, "A slot of textures.list.").length(1, max_node_name),
        field("image", &TextureSet::image,
              "A name from images.list; null: the texture of the scene file.")
            .length(1, max_scene_name),
        field("removed", &TextureSet::removed, "Instead of an image: no texture.").or_default(),
    };
  }
  bool operator==(const TextureSet&) const = default;
};

/// Of an edit document.
struct TextureEdit {
  static constexpr bool strict = true;
  std::string material;
  std::string slot;
  std::optional<std::string> image;

  static constexpr auto fields() {
    return std::tuple{
        field("material", &TextureEdit::material, "A name from materials.list.")
            .length(1, max_node_name),
        field("slot", &TextureEdit::slot, "A slot of textures.list.").length(1, max_node_name),
        field("image", &TextureEdit::image, "A name from images.list; null: no texture.")
            .length(1, max_scene_name)
            .or_null(),
    };
  }
  bool operator==(const TextureEdit&) const = default;
};

struct TextureState {
  TextureInfo texture;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("texture", &TextureState::texture, "The slot after the change."),
        field("rev", &TextureState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const TextureState&) const = default;
};

struct TexturesChanged {
  std::uint32_t rev = 0;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("rev", &TexturesChanged::rev, "Revision of the session's state."),
        field("by", &TexturesChanged::by, "The viewer that changed them; empty: the server."),
    };
  }
  bool operator==(const TexturesChanged&) const = default;
};

}  // namespace heliograph::protocol
