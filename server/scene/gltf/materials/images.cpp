#include "scene/gltf/materials/images.hpp"

#include <tbb/parallel_for.h>

#include "scene/first_failure.hpp"
#include "scene/image/image_decoder.hpp"
#include "scene/image/mipmaps.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

[[noreturn]] void refuse(const ImageSource& source, const std::string& reason) {
  throw ImportError(source.path + (source.name.empty() ? "" : " " + in_quotes(source.name)) + " " +
                    reason);
}

std::vector<ImageSize> probe_images(std::span<const ImageSource> sources,
                                    std::span<const ImageUse> uses, const ImportLimits& limits) {
  std::vector<ImageSize> sizes;
  std::uint64_t texels = 0;
  for (const ImageUse& use : uses) {
    const ImageSource& source = sources[use.source];
    try {
      sizes.push_back(probe_image(source.bytes));
    } catch (const ImportError& error) {
      refuse(source, error.what());
    }
    const auto [width, height] = sizes.back();
    if (width > limits.texture_size || height > limits.texture_size) {
      refuse(source, "is " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels: the limit is " + std::to_string(limits.texture_size));
    }
    texels += std::uint64_t(width) * height;
    if (texels > limits.texels) {
      throw ImportError("the images exceed the limit of " + std::to_string(limits.texels) +
                        " texels");
    }
  }
  return sizes;
}

using SharedFile = std::shared_ptr<const std::vector<std::uint8_t>>;

/// The encoded files of the images in use; those in buffers are copied, because buffers are
/// released.
std::vector<SharedFile> share_files(std::span<const ImageSource> sources,
                                    std::span<const ImageUse> uses) {
  std::vector<SharedFile> files(sources.size());
  for (const ImageUse& use : uses) {
    const ImageSource& source = sources[use.source];
    SharedFile& file = files[use.source];
    if (!file) file = source.file;
    if (!file) {
      file = std::make_shared<const std::vector<std::uint8_t>>(source.bytes.begin(),
                                                               source.bytes.end());
    }
  }
  return files;
}

/// Fills all levels of an image whose size is known.
void decode_levels(Image& image) {
  image.pixels.resize(mip_chain_bytes(image.width, image.height));
  decode_image(*image.file, {image.width, image.height}, image.pixels);
  fill_mip_chain(image);
}

Image decode(const ImageSource& source, const SharedFile& file, ImageSize size, bool srgb) {
  Image image;
  image.name = source.name;
  image.width = size.width;
  image.height = size.height;
  image.levels = mip_level_count(size.width, size.height);
  image.srgb = srgb;
  image.file = file;
  try {
    decode_levels(image);
  } catch (const ImportError& error) {
    refuse(source, error.what());
  }
  return image;
}

}  // namespace

std::vector<ImageSource> read_image_sources(GltfFile& file) {
  std::vector<ImageSource> result;
  for (const JsonValue& json : file.root().objects("images")) {
    ImageSource& source = result.emplace_back();
    source.path = json.path();
    source.name = json.text("name");
    if (const auto view = json.index("bufferView", file.views().size(), "buffer views")) {
      if (json.has("uri")) json.refuse("has both a uri and a buffer view");
      source.bytes = file.views()[*view].bytes;
    } else if (json.has("uri")) {
      source.file = std::make_shared<const std::vector<std::uint8_t>>(file.resource(json));
      source.bytes = *source.file;
    } else {
      json.refuse("has neither a uri nor a buffer view");
    }
  }
  return result;
}

std::vector<Image> decode_images(std::span<const ImageSource> sources,
                                 std::span<const ImageUse> uses, const ImportLimits& limits,
                                 const std::function<void()>& decoded) {
  const std::vector<ImageSize> sizes = probe_images(sources, uses, limits);
  const std::vector<SharedFile> files = share_files(sources, uses);
  std::vector<Image> images(uses.size());
  FirstFailure failure;
  tbb::parallel_for(std::size_t(0), uses.size(), [&](std::size_t i) {
    failure.guard([&] {
      const std::uint32_t source = uses[i].source;
      images[i] = decode(sources[source], files[source], sizes[i], uses[i].srgb);
      decoded();
    });
  });
  failure.rethrow();
  return images;
}

ImagePixels::ImagePixels(const Image& image) : pixels_(image.pixels) {
  if (!image.pixels.empty() || !image.file) return;
  Image again = image;
  decode_levels(again);
  decoded_ = std::move(again.pixels);
  pixels_ = decoded_;
}

}  // namespace heliograph::scene
