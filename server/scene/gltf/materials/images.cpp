#include "scene/gltf/materials/images.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <set>
#include <utility>

#include "scene/first_failure.hpp"
#include "scene/gltf/document/extension_value.hpp"
#include "scene/image/image_decoder.hpp"
#include "scene/image/mipmaps.hpp"
#include "scene/import_error.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

using ImageBytes = std::vector<std::uint8_t>;

[[noreturn]] void refuse(const ImageSource& source, const std::string& reason) {
  throw ImportError(source.path + (source.name.empty() ? "" : " " + in_quotes(source.name)) + " " +
                    reason);
}

/// Runs `task` for an image; returns why it failed, where neither it is required nor assets are
/// strict.
template <typename Task>
std::string try_image(const ImageSource& source, const ImportLimits& limits, const Task& task) {
  try {
    task();
  } catch (const ImportError& error) {
    if (limits.strict_assets || source.required) refuse(source, error.what());
    return source.path + (source.name.empty() ? "" : " " + in_quotes(source.name)) + " " +
           error.what();
  }
  return "";
}

void check_size(const ImageSource& source, ImageSize size, const ImportLimits& limits) {
  if (size.width <= limits.texture_size && size.height <= limits.texture_size) return;
  refuse(source, "is " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                     " pixels: the limit is " + std::to_string(limits.texture_size));
}

/// Sizes of all images, 0 where there is a problem.
std::vector<ImageSize> probe_images(std::span<const ImageSource> sources,
                                    std::span<const ImageUse> uses, const ImportLimits& limits,
                                    TexelBudget& budget, std::vector<std::string>& problems) {
  std::vector<ImageSize> sizes(uses.size());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const ImageSource& source = sources[uses[i].source];
    for (const std::uint32_t index : uses[i].sources()) {
      if (problems[i].empty()) problems[i] = sources[index].problem;
      if (!problems[i].empty()) continue;
      problems[i] = try_image(sources[index], limits, [&] {
        const ImageSize own = probe_image(sources[index].bytes);
        sizes[i] = {std::max(sizes[i].width, own.width), std::max(sizes[i].height, own.height)};
      });
    }
    check_size(source, sizes[i], limits);
    budget.take(sizes[i]);
  }
  return sizes;
}

/// Fills all levels of an image whose size is known.
void decode_levels(Image& image, const std::stop_token& stop) {
  image.pixels.resize(mip_chain_bytes(image.width, image.height));
  decode_image(*image.file, {image.width, image.height}, image.pixels);
  throw_if_cancelled(stop);
  fill_mip_chain(image);
}

/// An image and its decoded texels, where there is one.
struct DecodedSource {
  ImageSize size;
  std::vector<std::uint8_t> rgba;

  DecodedSource(std::span<const ImageSource> sources, std::optional<std::uint32_t> index) {
    if (!index) return;
    size = probe_image(sources[*index].bytes);
    rgba.resize(std::size_t(size.width) * size.height * 4);
    decode_image(sources[*index].bytes, size, rgba);
  }
  SourceTexels texels() const { return {size, rgba}; }
};

/// Not kept with a file: its texels stay in memory.
void convert_levels(std::span<const ImageSource> sources, const ImageConversion& conversion,
                    Image& image) {
  const DecodedSource diffuse(sources, conversion.diffuse);
  const DecodedSource specular(sources, conversion.specular);
  image.pixels.resize(mip_chain_bytes(image.width, image.height));
  convert_texels(conversion.kind, conversion.factors, diffuse.texels(), specular.texels(),
                 {image.width, image.height}, image.pixels);
  fill_mip_chain(image);
}

Image decode(std::span<const ImageSource> sources, const ImageUse& use, ImageSize size,
             const std::stop_token& stop) {
  Image image;
  image.name = sources[use.source].name;
  image.width = size.width;
  image.height = size.height;
  image.levels = mip_level_count(size.width, size.height);
  image.srgb = use.srgb;
  if (use.conversion) {
    convert_levels(sources, *use.conversion, image);
  } else {
    image.file = sources[use.source].file;
    decode_levels(image, stop);
  }
  return image;
}

/// The longest side of levels that stay of images of such sizes.
std::uint32_t kept_side(std::span<const ImageSize> sizes, const KeptTextures& kept) {
  std::vector<Image> images(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    images[i].width = sizes[i].width;
    images[i].height = sizes[i].height;
    images[i].levels = mip_level_count(sizes[i].width, sizes[i].height);
  }
  return longest_side_that_fits(images, kept).value_or(1);
}

Image white_texel(const ImageSource& source, bool srgb) {
  Image image;
  image.name = source.name;
  image.damaged = true;
  image.width = image.height = 1;
  image.srgb = srgb;
  image.pixels.assign(4, 255);
  return image;
}

}  // namespace

std::vector<std::uint32_t> ImageUse::sources() const {
  if (!conversion) return {source};
  std::vector<std::uint32_t> result;
  if (conversion->diffuse) result.push_back(*conversion->diffuse);
  if (conversion->specular) result.push_back(*conversion->specular);
  return result;
}

std::uint64_t image_file_bytes(const GltfFile& file) {
  std::uint64_t bytes = 0;
  std::set<std::uint32_t> counted;  // views
  const std::vector<tinygltf::Image>& images = file.model().images;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (const auto view = to_index(images[i].bufferView)) {
      if (counted.insert(*view).second) bytes += file.model().bufferViews[*view].byteLength;
    } else {
      bytes += file.resource_bytes(item_path("", "images", i));
    }
  }
  return bytes;
}

const ImageSource& ImageFiles::at(std::uint32_t image) {
  if (!sources_[image]) sources_[image] = read(image);
  return *sources_[image];
}

std::vector<ImageSource> ImageFiles::take_all() {
  std::vector<ImageSource> result;
  for (std::uint32_t i = 0; i < sources_.size(); ++i) {
    at(i);
    result.push_back(std::move(*sources_[i]));
  }
  sources_.clear();
  known_.clear();
  return result;
}

ImageSource ImageFiles::read(std::uint32_t image) {
  throw_if_cancelled(stop_);
  const tinygltf::Image& document = file_.model().images[image];
  ImageSource source;
  source.path = item_path("", "images", image);
  source.name = document.name;
  if (const auto view = to_index(document.bufferView)) {
    source.file = known_[*view];
    if (!source.file) {
      // Views may overlap, so that the file's size is no limit.
      bytes_ += file_.model().bufferViews[*view].byteLength;
      if (bytes_ > limits_.file_bytes) {
        throw ImportError(source.path + ": the images have more than the " +
                          std::to_string(limits_.file_bytes) + " bytes of the limit on files");
      }
      known_[*view] = source.file = std::make_shared<const ImageBytes>(file_.image_file(*view));
    }
    source.bytes = *source.file;
    return source;
  }
  try {
    source.file = std::make_shared<const ImageBytes>(file_.resource(source.path));
    source.bytes = *source.file;
  } catch (const MissingFile& error) {
    if (limits_.strict_assets) throw;
    source.problem = error.what();
  }
  return source;
}

void TexelBudget::take(ImageSize size) {
  const std::uint64_t texels = std::uint64_t(size.width) * size.height;
  if (texels > left_) {
    throw ImportError("the images exceed the limit of " + std::to_string(all_) + " texels");
  }
  left_ -= texels;
}

ImageTexels decode_texels(const ImageSource& source, const ImportLimits& limits,
                          TexelBudget& budget) {
  ImageTexels result;
  result.problem = source.problem;
  if (!result.problem.empty()) return result;
  result.problem = try_image(source, limits, [&] { result.size = probe_image(source.bytes); });
  if (!result.problem.empty()) return result;
  check_size(source, result.size, limits);
  budget.take(result.size);
  result.problem = try_image(source, limits, [&] {
    result.rgba.resize(std::size_t(result.size.width) * result.size.height * 4);
    decode_image(source.bytes, result.size, result.rgba);
  });
  return result;
}

DecodedImages decode_images(std::span<const ImageSource> sources, std::span<const ImageUse> uses,
                            const KeptLevels& kept, const ImportLimits& limits, TexelBudget& budget,
                            const std::stop_token& stop, const std::function<void()>& decoded) {
  DecodedImages result;
  result.images.resize(uses.size());
  result.problems.resize(uses.size());
  const std::vector<ImageSize> sizes = probe_images(sources, uses, limits, budget, result.problems);
  result.kept_side = kept_side(sizes, kept.textures);
  FirstFailure failure;
  tbb::parallel_for(std::size_t(0), uses.size(), [&](std::size_t i) {
    failure.guard([&] {
      const std::uint32_t source = uses[i].source;
      std::string& problem = result.problems[i];
      if (problem.empty()) {
        problem = try_image(sources[source], limits,
                            [&] { result.images[i] = decode(sources, uses[i], sizes[i], stop); });
      }
      if (!problem.empty()) result.images[i] = white_texel(sources[source], uses[i].srgb);
      if (!kept.whole[i]) drop_large_levels(result.images[i], result.kept_side);
      decoded();
    });
  });
  failure.rethrow();
  return result;
}

void drop_large_levels(Image& image, std::uint32_t longest_side) {
  if (!image.file || image.pixels.empty()) return;
  const std::uint32_t before = first_level_in(image, image.pixels.size());
  const std::uint32_t first = first_level_within(image, longest_side);
  if (first <= before) return;
  const auto kept =
      std::span(image.pixels).subspan(level_offset(image, first) - level_offset(image, before));
  image.pixels = std::vector<std::uint8_t>(kept.begin(), kept.end());
}

ImagePixels::ImagePixels(const Image& image, std::uint32_t first) : pixels_(image.pixels) {
  const bool enough = !pixels_.empty() && first_level_in(image, pixels_.size()) <= first;
  if (enough || !image.file) return;
  Image again = image;
  again.pixels = {};
  decode_levels(again, {});
  decoded_ = std::move(again.pixels);
  pixels_ = decoded_;
}

}  // namespace heliograph::scene
