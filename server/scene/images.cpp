#include "scene/images.hpp"

#include <tbb/parallel_for.h>

#include "scene/first_failure.hpp"
#include "scene/image_decoder.hpp"
#include "scene/mipmaps.hpp"
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
      throw ImportError("the images hold more than the limit of " + std::to_string(limits.texels) +
                        " texels");
    }
  }
  return sizes;
}

Image decode(const ImageSource& source, ImageSize size, bool srgb) {
  Image image;
  image.name = source.name;
  image.width = size.width;
  image.height = size.height;
  image.levels = mip_level_count(size.width, size.height);
  image.srgb = srgb;
  image.pixels.resize(mip_chain_bytes(size.width, size.height));
  try {
    decode_image(source.bytes, size, image.pixels);
  } catch (const ImportError& error) {
    refuse(source, error.what());
  }
  fill_mip_chain(image);
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
      source.loaded = file.resource(json);
      source.bytes = source.loaded;
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
  std::vector<Image> images(uses.size());
  FirstFailure failure;
  tbb::parallel_for(std::size_t(0), uses.size(), [&](std::size_t i) {
    failure.guard([&] {
      images[i] = decode(sources[uses[i].source], sizes[i], uses[i].srgb);
      decoded();
    });
  });
  failure.rethrow();
  return images;
}

}  // namespace heliograph::scene
