#include "gpu/memory/image.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "gpu/memory/readback.hpp"

namespace heliograph::gpu {
namespace {

VkExtent2D level_extent(const ImageDesc& desc, std::uint32_t level) {
  return {std::max(1u, desc.extent.width >> level), std::max(1u, desc.extent.height >> level)};
}

VkImageAspectFlags aspect_of(VkFormat format) {
  return is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageCreateInfo image_info(const Device& device, const ImageDesc& desc) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.flags = desc.cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.extent.width, desc.extent.height, 1};
  info.mipLevels = desc.levels;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = desc.mapped ? VK_IMAGE_TILING_LINEAR : VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  share_between_queues(device, info);
  return info;
}

}  // namespace

bool is_depth(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT;
}

std::uint32_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT:
      return 4;
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
      return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    default:
      throw GpuError("no texel size known for " + std::string(format_name(format)));
  }
}

VkDeviceSize level_bytes(VkFormat format, VkExtent2D size) {
  if (format == VK_FORMAT_BC7_UNORM_BLOCK || format == VK_FORMAT_BC7_SRGB_BLOCK) {
    return VkDeviceSize{(size.width + 3) / 4} * ((size.height + 3) / 4) * 16;
  }
  return VkDeviceSize{size.width} * size.height * texel_bytes(format);
}

VkDeviceSize packed_bytes(const ImageDesc& desc) {
  VkDeviceSize bytes = 0;
  for (std::uint32_t level = 0; level < desc.levels; ++level) {
    bytes += level_bytes(desc.format, level_extent(desc, level)) * desc.layers;
  }
  return bytes;
}

const char* format_name(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8G8B8A8_UNORM:
      return "rgba8";
    case VK_FORMAT_R8G8B8A8_SRGB:
      return "rgba8 sRGB";
    case VK_FORMAT_BC7_UNORM_BLOCK:
      return "bc7";
    case VK_FORMAT_BC7_SRGB_BLOCK:
      return "bc7 sRGB";
    case VK_FORMAT_R32_UINT:
      return "r32ui";
    case VK_FORMAT_R32_SFLOAT:
      return "r32f";
    case VK_FORMAT_D32_SFLOAT:
      return "d32f";
    case VK_FORMAT_R32G32_UINT:
      return "rg32ui";
    case VK_FORMAT_R32G32_SFLOAT:
      return "rg32f";
    case VK_FORMAT_R16G16_SFLOAT:
      return "rg16f";
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return "rgba16f";
    case VK_FORMAT_R16G16B16A16_UNORM:
      return "rgba16";
    case VK_FORMAT_R32G32B32A32_UINT:
      return "rgba32ui";
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return "rgba32f";
    case VK_FORMAT_UNDEFINED:
      return "no format";
    default:
      return "another format";
  }
}

VkMemoryRequirements Image::requirements(const Device& device, const ImageDesc& desc) {
  const VkImageCreateInfo made = image_info(device, desc);
  VkDeviceImageMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS};
  info.pCreateInfo = &made;
  VkMemoryRequirements2 found{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
  vkGetDeviceImageMemoryRequirements(device.handle(), &info, &found);
  return found.memoryRequirements;
}

// A constructor that delegates leaves what it has made to the destructor when it fails half way.
Image::Image(const Device& device, ImageDesc desc, MemoryPlace place, VkCommandBuffer setup)
    : Image() {
  device_ = &device;
  desc_ = std::move(desc);
  const VkImageCreateInfo info = image_info(device, desc_);
  check(vkCreateImage(device.handle(), &info, nullptr, &handle_), "create an image");
  bind_memory(std::move(place));
  device.name(VK_OBJECT_TYPE_IMAGE, handle_, desc_.name);
  view_ = make_view(0, desc_.levels, false);
  if (desc_.usage & VK_IMAGE_USAGE_STORAGE_BIT) {
    for (std::uint32_t i = 0; i < desc_.levels; ++i) level_views_.push_back(make_view(i, 1, true));
  }
  record_now_or_into(setup, [this](VkCommandBuffer commands) { initialise_layout(commands); });
}

void Image::record_now_or_into(VkCommandBuffer setup,
                               const std::function<void(VkCommandBuffer)>& record) const {
  if (setup) {
    record(setup);
  } else {
    device_->submit_once(record);
  }
}

void Image::bind_memory(MemoryPlace place) {
  void* address = nullptr;
  if (place.block) {
    block_ = std::move(place.block);
    check(vkBindImageMemory(device_->handle(), handle_, block_->handle(), place.offset),
          "bind an image's place");
    address = block_->mapped(place.offset);
    if (!desc_.mapped) return;
  } else {
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device_->handle(), handle_, &requirements);
    constexpr VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    memory_ = device_->allocate(requirements, desc_.mapped ? host : 0,
                                VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, desc_.name);
    check(vkBindImageMemory(device_->handle(), handle_, memory_, 0), "bind an image's memory");
    own_bytes_ = requirements.size;
    if (!desc_.mapped) return;
    check(vkMapMemory(device_->handle(), memory_, 0, VK_WHOLE_SIZE, 0, &address), "map an image");
  }
  const VkImageSubresource part{aspect_of(desc_.format), 0, 0};
  VkSubresourceLayout layout;
  vkGetImageSubresourceLayout(device_->handle(), handle_, &part, &layout);
  host_ = {static_cast<std::byte*>(address) + layout.offset, layout.rowPitch};
}

Image::~Image() {
  if (!device_) return;
  for (const VkImageView view : level_views_) vkDestroyImageView(device_->handle(), view, nullptr);
  vkDestroyImageView(device_->handle(), view_, nullptr);
  vkDestroyImage(device_->handle(), handle_, nullptr);
  device_->free(memory_);
}

void Image::swap(Image& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(desc_, other.desc_);
  std::swap(handle_, other.handle_);
  std::swap(memory_, other.memory_);
  std::swap(own_bytes_, other.own_bytes_);
  std::swap(block_, other.block_);
  std::swap(view_, other.view_);
  std::swap(level_views_, other.level_views_);
  std::swap(host_, other.host_);
}

VkImageView Image::make_view(std::uint32_t first_level, std::uint32_t levels, bool storage) const {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = handle_;
  // Storage access sees a cube as six layers.
  if (desc_.cube && !storage)
    info.viewType = VK_IMAGE_VIEW_TYPE_CUBE;
  else
    info.viewType = desc_.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  info.format = desc_.format;
  info.subresourceRange = {aspect_of(desc_.format), first_level, levels, 0, desc_.layers};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(device_->handle(), &info, nullptr, &view), "create an image view");
  return view;
}

void Image::initialise_layout(VkCommandBuffer commands) const {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  // Another image may have been cleared in the same memory.
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = handle_;
  barrier.subresourceRange = {aspect_of(desc_.format), 0, desc_.levels, 0, desc_.layers};
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

void Image::clear(VkCommandBuffer setup) const {
  record_now_or_into(setup, [this](VkCommandBuffer commands) {
    const VkImageSubresourceRange range{aspect_of(desc_.format), 0, desc_.levels, 0, desc_.layers};
    const VkClearColorValue zero{};
    vkCmdClearColorImage(commands, handle_, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &range);
    full_barrier(commands);
  });
}

void Image::upload(std::span<const std::byte> bytes) const {
  const Buffer staging(*device_, desc_.name + " upload", bytes.size(), 0, Memory::upload);
  std::memcpy(staging.mapped(), bytes.data(), bytes.size());
  std::vector<VkBufferImageCopy> regions;
  VkDeviceSize offset = 0;
  for (std::uint32_t level = 0; level < desc_.levels && offset < bytes.size(); ++level) {
    const VkExtent2D size = level_extent(desc_, level);
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {aspect_of(desc_.format), level, 0, desc_.layers};
    region.imageExtent = {size.width, size.height, 1};
    regions.push_back(region);
    offset += level_bytes(desc_.format, size) * desc_.layers;
  }
  if (offset > bytes.size()) throw GpuError("too few bytes for the image " + desc_.name);
  device_->submit_once([&](VkCommandBuffer commands) {
    vkCmdCopyBufferToImage(commands, staging.handle(), handle_, VK_IMAGE_LAYOUT_GENERAL,
                           static_cast<std::uint32_t>(regions.size()), regions.data());
    full_barrier(commands);
  });
}

std::vector<std::byte> Image::download(std::uint32_t layer) const {
  const Readback readback(*device_, *this);
  if (!host_.data || layer > 0) {
    device_->submit_once(
        [&](VkCommandBuffer commands) { readback.record(commands, *this, layer); });
  }
  return readback.read<std::byte>(*this, layer);
}

std::vector<std::byte> Image::download_level(std::uint32_t level, std::uint32_t layer) const {
  const VkExtent2D size = level_extent(desc_, level);
  std::vector<std::byte> bytes(level_bytes(desc_.format, size));
  const Buffer staging(*device_, desc_.name + " download", bytes.size(), 0, Memory::readback);
  device_->submit_once([&](VkCommandBuffer commands) {
    full_barrier(commands);
    VkBufferImageCopy region{};
    region.imageSubresource = {aspect_of(desc_.format), level, layer, 1};
    region.imageExtent = {size.width, size.height, 1};
    vkCmdCopyImageToBuffer(commands, handle_, VK_IMAGE_LAYOUT_GENERAL, staging.handle(), 1,
                           &region);
    full_barrier(commands);
  });
  std::memcpy(bytes.data(), staging.mapped(), bytes.size());
  return bytes;
}

Sampler::Sampler(const Device& device, const VkSamplerCreateInfo& info) : device_(&device) {
  check(vkCreateSampler(device.handle(), &info, nullptr, &handle_), "create a sampler");
}

Sampler::~Sampler() {
  if (device_) vkDestroySampler(device_->handle(), handle_, nullptr);
}

void Sampler::swap(Sampler& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
}

}  // namespace heliograph::gpu
