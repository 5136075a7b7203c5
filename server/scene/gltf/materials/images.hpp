#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/materials/specular_glossiness.hpp"
#include "scene/image/mipmaps.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The encoded bytes of one of the document's images.
struct ImageSource {
  std::string path;  // for errors: "images[2]"
  std::string name;
  std::shared_ptr<const std::vector<std::uint8_t>> file;
  std::span<const std::uint8_t> bytes;  // of `file`
  std::string problem;                  // why there are no bytes
  bool required = false;                // damage refuses the scene, as with strict assets
};

/// An image that is computed from two others of the specular-glossiness model.
struct ImageConversion {
  ConvertedImage kind = ConvertedImage::base_color;
  SpecularGlossiness factors;
  std::optional<std::uint32_t> diffuse;
  std::optional<std::uint32_t> specular;
  bool operator==(const ImageConversion&) const = default;
};

/// One use of an image: an image used both as color and as data is decoded twice.
struct ImageUse {
  std::uint32_t source = 0;
  bool srgb = false;
  std::optional<ImageConversion> conversion = std::nullopt;  // `source` is one of its images

  /// All images that it reads.
  std::vector<std::uint32_t> sources() const;
};

/// Bytes of the files of all images, none of which is read for it; 0 for those that are missing.
std::uint64_t image_file_bytes(const GltfFile& file);

/// The files of a document's images, each read once, when it is asked for first.
class ImageFiles {
 public:
  /// The arguments outlive this.
  ImageFiles(GltfFile& file, const ImportLimits& limits, const std::stop_token& stop)
      : file_(file), limits_(limits), stop_(stop), sources_(file.model().images.size()) {}

  /// @throws ImportError, LoadCancelled
  const ImageSource& at(std::uint32_t image);
  /// Those of all images; none is left here. @throws ImportError, LoadCancelled
  std::vector<ImageSource> take_all();

 private:
  using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

  ImageSource read(std::uint32_t image);

  GltfFile& file_;
  const ImportLimits& limits_;
  const std::stop_token& stop_;
  std::vector<std::optional<ImageSource>> sources_;
  std::map<std::uint32_t, Bytes> known_;  // by view
  std::uint64_t bytes_ = 0;               // of views
};

/// Texels that a file's images may still have.
class TexelBudget {
 public:
  explicit TexelBudget(std::uint64_t texels) : all_(texels), left_(texels) {}
  /// @throws ImportError when the budget is exceeded
  void take(ImageSize size);

 private:
  std::uint64_t all_;
  std::uint64_t left_;
};

/// An image alone, without mip levels.
struct ImageTexels {
  ImageSize size;
  std::vector<std::uint8_t> rgba;  // top row first
  std::string problem;             // why there are none: the image is missing or damaged
};

/// @throws ImportError when a limit is exceeded, or the image is damaged with strict assets
ImageTexels decode_texels(const ImageSource& source, const ImportLimits& limits,
                          TexelBudget& budget);

/// The images of all uses. Those that are missing or damaged are one white texel, unless assets are
/// strict or the image is required.
struct DecodedImages {
  std::vector<Image> images;
  std::vector<std::string> problems;  // per image; empty: none
  std::uint32_t kept_side = 0;        // the longest of the levels that stay
};

/// Which levels of decoded images stay.
struct KeptLevels {
  KeptTextures textures;    // of images with a file
  std::vector<bool> whole;  // per use: all levels stay
};

/// Decodes every use, with mip levels, in parallel. `decoded` is called after each, on any thread.
/// @throws ImportError when a limit is exceeded, or an image is damaged that is required or with
/// strict assets; LoadCancelled
DecodedImages decode_images(std::span<const ImageSource> sources, std::span<const ImageUse> uses,
                            const KeptLevels& kept, const ImportLimits& limits, TexelBudget& budget,
                            const std::stop_token& stop, const std::function<void()>& decoded);

/// Removes the levels of an image whose sides are longer, if it has a file.
void drop_large_levels(Image& image, std::uint32_t longest_side);

/// Levels of an image, decoded again if its pixels were released.
class ImagePixels {
 public:
  /// `image` outlives this. Levels from `first` on are needed, and there may be more.
  ImagePixels(const Image& image, std::uint32_t first);

  std::span<const std::uint8_t> get() const { return pixels_; }

 private:
  std::vector<std::uint8_t> decoded_;
  std::span<const std::uint8_t> pixels_;
};

}  // namespace heliograph::scene
