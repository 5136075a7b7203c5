#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The encoded bytes of one of the document's images.
struct ImageSource {
  std::string path;  // for errors: "images[2]"
  std::string name;
  std::shared_ptr<const std::vector<std::uint8_t>> file;  // when not part of a buffer
  std::span<const std::uint8_t> bytes;
};

/// One use of an image: an image used both as color and as data is decoded twice.
struct ImageUse {
  std::uint32_t source = 0;
  bool srgb = false;
};

/// @throws ImportError
std::vector<ImageSource> read_image_sources(GltfFile& file);

/// Decodes every use, with mip levels, in parallel. `decoded` is called after each, on any thread.
/// @throws ImportError when an image is damaged or a limit is exceeded
std::vector<Image> decode_images(std::span<const ImageSource> sources,
                                 std::span<const ImageUse> uses, const ImportLimits& limits,
                                 const std::function<void()>& decoded);

/// All levels of an image, decoded again if its pixels were released.
class ImagePixels {
 public:
  /// `image` outlives this.
  explicit ImagePixels(const Image& image);

  std::span<const std::uint8_t> get() const { return pixels_; }

 private:
  std::vector<std::uint8_t> decoded_;
  std::span<const std::uint8_t> pixels_;
};

}  // namespace heliograph::scene
