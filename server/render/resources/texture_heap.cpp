#include "render/resources/texture_heap.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "render/resources/heap_textures.hpp"
#include "scene/image/mipmaps.hpp"

namespace heliograph::render {
namespace {

constexpr VkBufferUsageFlags texel_usage = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

std::uint32_t side(std::uint32_t size, std::uint32_t level) {
  return std::max(size >> level, 1u);
}

std::uint64_t texels(const scene::Image& image, std::uint32_t first, std::uint32_t last) {
  std::uint64_t sum = 0;
  for (std::uint32_t level = first; level < last; ++level) {
    sum += std::uint64_t{side(image.width, level)} * side(image.height, level);
  }
  return sum;
}

std::uint32_t flags(const scene::Image& image, const scene::Sampler& sampler) {
  const auto bit = [](bool on, std::uint32_t flag) { return on ? flag : 0u; };
  return bit(image.srgb, shared::texture_srgb) |
         bit(sampler.magnify == scene::Filter::nearest, shared::texture_magnify_nearest) |
         bit(sampler.minify == scene::Filter::nearest, shared::texture_minify_nearest) |
         bit(sampler.mip_filter == scene::Filter::nearest, shared::texture_levels_nearest);
}

/// The heap keeps the last levels.
void copy_texels(const HeapPlan::Slot& slot, std::span<const std::uint8_t> pixels,
                 std::uint32_t* heap) {
  const auto kept = pixels.last(slot.kept * 4);
  std::ranges::copy(kept, reinterpret_cast<std::uint8_t*>(heap + slot.first));
}

/// Finds images that have the same texels as one before, by their encoded files.
class KnownImages {
 public:
  /// The number of the first such image; `number` where there is none.
  std::size_t first_like(const scene::Image& image, std::size_t number) {
    if (!image.file) return number;
    const std::string_view content(reinterpret_cast<const char*>(image.file->data()),
                                   image.file->size());
    return numbers_.try_emplace({image.srgb, content}, number).first->second;
  }

 private:
  std::map<std::pair<bool, std::string_view>, std::size_t> numbers_;
};

/// @throws gpu::GpuError when the images do not fit
HeapPlan plan_heap(const scene::Scene& scene, const scene::KeptTextures& kept) {
  const auto fitting = scene::longest_side_that_fits(scene.images, kept);
  if (!fitting) {
    throw gpu::GpuError("the scene's " + std::to_string(scene.images.size()) +
                        " images do not fit into one buffer of this device, which holds " +
                        std::to_string(kept.most_texels) + " texels");
  }
  const std::uint32_t longest = *fitting;
  HeapPlan plan;
  KnownImages known;
  for (const scene::Image& image : scene.images) {
    const std::uint32_t level = scene::first_level_within(image, longest);
    const std::size_t first = known.first_like(image, plan.slots.size());
    if (first < plan.slots.size()) {
      plan.slots.push_back({plan.slots[first].skipped, 0, plan.slots[first].first});
      continue;
    }
    plan.slots.push_back(
        {texels(image, 0, level), texels(image, level, image.levels), plan.texels});
    plan.texels += plan.slots.back().kept;
  }
  for (const scene::Texture& texture : scene.textures) {
    const scene::Image& image = scene.images[texture.image];
    const std::uint32_t level = scene::first_level_within(image, longest);
    shared::HeapTexture entry{};
    entry.first_texel = static_cast<std::uint32_t>(plan.slots[texture.image].first);
    entry.width = side(image.width, level);
    entry.height = side(image.height, level);
    entry.levels = texture.sampler.mipmapped ? image.levels - level : 1;
    entry.wrap_s = texture.sampler.wrap_s;
    entry.wrap_t = texture.sampler.wrap_t;
    entry.flags = flags(image, texture.sampler);
    plan.textures.push_back(entry);
  }
  return plan;
}

}  // namespace

PackedTextures pack_textures(const scene::Scene& scene, std::uint64_t most_texels) {
  HeapPlan plan = plan_heap(scene, {longest_heap_side, most_texels});
  PackedTextures packed{std::vector<std::uint32_t>(plan.texels), std::move(plan.textures)};
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    copy_texels(plan.slots[i], scene.images[i].pixels, packed.texels.data());
  }
  return packed;
}

TextureHeapWriter::TextureHeapWriter(const gpu::Device& device, const scene::Scene& scene)
    : device_(device), plan_(plan_heap(scene, heap_textures(device))) {
  if (device.is_cpu()) {
    texels_ =
        gpu::Buffer(device, "texture heap", 4 * plan_.texels, texel_usage, gpu::Memory::device);
  } else {
    gathered_.resize(plan_.texels);
  }
}

void TextureHeapWriter::add(std::size_t image, std::span<const std::uint8_t> pixels) {
  copy_texels(plan_.slots[image], pixels,
              texels_ ? reinterpret_cast<std::uint32_t*>(texels_.mapped()) : gathered_.data());
}

TextureHeap TextureHeapWriter::finish() {
  if (!texels_) {
    texels_ = gpu::upload_buffer(device_, "texture heap", std::as_bytes(std::span(gathered_)),
                                 texel_usage);
  }
  texels_.texel_view(VK_FORMAT_R32_UINT);  // before other threads share it
  return {std::move(texels_),
          gpu::upload_buffer(device_, "textures", std::as_bytes(std::span(plan_.textures)),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)};
}

}  // namespace heliograph::render
