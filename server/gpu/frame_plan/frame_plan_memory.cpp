// Which resources of a plan share memory, and how they are made.

#include <algorithm>
#include <optional>

#include "gpu/frame_plan/frame_plan_parts.hpp"
#include "gpu/frame_plan/memory_plan.hpp"

namespace heliograph::gpu {
namespace {

/// Small enough for every driver.
constexpr std::uint64_t most_block_bytes = std::uint64_t{1} << 30;
/// Smaller buffers are counters, which the host reads when it likes.
constexpr VkDeviceSize least_shared_bytes = 4096;

/// Of a resource that is still to be made.
template <class Resource>
VkMemoryRequirements requirements_of(const Device& device, const Resource& resource) {
  if (resource.image_desc) return Image::requirements(device, *resource.image_desc);
  return Buffer::requirements(device, resource.buffer_desc->size, resource.buffer_desc->usage);
}

}  // namespace

void FramePlan::make(Resource& resource, MemoryPlace place) const {
  if (resource.image_desc) {
    const auto made =
        std::make_shared<const Image>(device_, *resource.image_desc, std::move(place));
    resource.owned_images = {made, made};
    resource.images = {made.get(), made.get()};
  } else if (const auto& buffer = resource.buffer_desc) {
    resource.owned_buffer = std::make_shared<const Buffer>(
        device_, resource.name, buffer->size, buffer->usage, buffer->memory, std::move(place));
    resource.buffer = resource.owned_buffer.get();
  }
}

std::optional<Lifetime> FramePlan::shared_lifetime(std::uint32_t index) const {
  const Resource& resource = resources_[index];
  if (resource.is_made()) return std::nullopt;
  const auto& buffer = resource.buffer_desc;
  if (buffer && (buffer->memory != Memory::device || buffer->size < least_shared_bytes)) {
    return std::nullopt;
  }
  if (resource.image_desc && !resource.image_desc->mapped) return std::nullopt;
  std::optional<Lifetime> lifetime;
  for (std::uint32_t i = 0; i < passes_.size(); ++i) {
    const Pass& pass = passes_[i];
    for (const Use& use : pass.all_uses()) {
      if (use.resource != index) continue;
      if (!lifetime) {
        if (use.access != Access::write) return std::nullopt;  // it comes from the frame before
        lifetime.emplace().first = i;
      }
      lifetime->last = i;
    }
  }
  if (!lifetime) return std::nullopt;
  // Every image can be looked at after the frame.
  if (resource.image_desc) lifetime->last = static_cast<std::uint32_t>(passes_.size());
  const VkMemoryRequirements needed = requirements_of(device_, resource);
  lifetime->bytes = needed.size;
  lifetime->alignment = needed.alignment;
  return lifetime;
}

// Every pass is a submit of its own on the devices where memory is shared: what a pass writes where
// another resource lay needs no further barrier.
void FramePlan::make_resources() {
  VkMemoryRequirements all{.size = 0, .alignment = 1, .memoryTypeBits = ~0u};
  std::vector<std::uint32_t> shared;
  std::vector<Lifetime> lifetimes;
  for (std::uint32_t i = 0; i < resources_.size(); ++i) {
    if (const auto lifetime = shared_lifetime(i)) {
      shared.push_back(i);
      lifetimes.push_back(*lifetime);
      all.memoryTypeBits &= requirements_of(device_, resources_[i]).memoryTypeBits;
    }
  }
  const MemoryPlan plan = plan_memory(lifetimes, most_block_bytes);
  std::vector<std::shared_ptr<const MemoryBlock>> blocks;
  for (const std::uint64_t bytes : plan.block_bytes) {
    all.size = bytes;
    blocks.push_back(std::make_shared<const MemoryBlock>(device_, all, "a frame's resources"));
  }
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const MemoryPlan::Place& place = plan.places[i];
    make(resources_[shared[i]], {blocks[place.block], place.offset});
  }
  for (Resource& resource : resources_) {
    if (!resource.is_made()) make(resource, {});
  }
}

bool FramePlan::was_written(std::uint32_t index) const {
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    if (timings_[i].milliseconds < 0.0f) continue;
    for (const Use& use : passes_[i].all_uses()) {
      if (use.resource == index && use.access != Access::read) return true;
    }
  }
  return false;
}

std::uint64_t FramePlan::memory_bytes() const {
  std::uint64_t bytes = 0;
  std::vector<const MemoryBlock*> blocks;
  const auto count = [&](const auto* part) {
    if (!part) return;
    bytes += part->own_bytes();
    const MemoryBlock* const block = part->block();
    if (!block || std::find(blocks.begin(), blocks.end(), block) != blocks.end()) return;
    blocks.push_back(block);
    bytes += block->size();
  };
  for (const Resource& resource : resources_) {
    count(resource.owned_buffer.get());
    count(resource.owned_images[0].get());
    if (resource.owned_images[1] != resource.owned_images[0]) count(resource.owned_images[1].get());
  }
  return bytes;
}

}  // namespace heliograph::gpu
