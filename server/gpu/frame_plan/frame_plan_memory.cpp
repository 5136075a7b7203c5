// Which resources of a plan share memory, and how they are made.

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "gpu/frame_plan/frame_plan_parts.hpp"
#include "gpu/frame_plan/memory_plan.hpp"

namespace heliograph::gpu {
namespace {

/// Small enough for every driver.
constexpr std::uint64_t most_block_bytes = std::uint64_t{1} << 30;
/// On a GPU, where a submit may have to wait for the allocation of a whole block.
constexpr std::uint64_t most_gpu_block_bytes = std::uint64_t{32} << 20;
/// Smaller buffers are counters, which the host reads when it likes.
constexpr VkDeviceSize least_shared_bytes = 4096;

/// Of a resource that is still to be made.
template <class Resource>
VkMemoryRequirements requirements_of(const Device& device, const Resource& resource) {
  if (resource.image_desc) return Image::requirements(device, *resource.image_desc);
  return Buffer::requirements(device, resource.buffer_desc->size, resource.buffer_desc->usage);
}

}  // namespace

void FramePlan::make(Resource& resource, const std::array<MemoryPlace, 2>& places) const {
  const bool same = places[0].block == places[1].block && places[0].offset == places[1].offset;
  for (std::size_t parity = 0; parity < 2; ++parity) {
    auto& image = resource.owned_images[parity];
    auto& buffer = resource.owned_buffers[parity];
    if (parity == 1 && same) {
      image = resource.owned_images[0];
      buffer = resource.owned_buffers[0];
    } else if (resource.image_desc) {
      image = std::make_shared<const Image>(device_, *resource.image_desc, places[parity], setup_);
      // Passes may read what the passes that write it have skipped since the plan was made.
      if (image->host() && !image->block()) image->clear(setup_);
    } else if (const auto& desc = resource.buffer_desc) {
      buffer = std::make_shared<const Buffer>(device_, resource.name, desc->size, desc->usage,
                                              desc->memory, places[parity]);
    }
    resource.images[parity] = image.get();
    resource.buffers[parity] = buffer.get();
  }
}

void FramePlan::make_history(std::uint32_t current, const std::array<MemoryPlace, 2>& places) {
  Resource& written = resources_[current];
  Resource& read = resources_[current + 1];
  for (std::size_t parity = 0; parity < 2; ++parity) {
    auto& image = written.owned_images[parity];
    image = std::make_shared<const Image>(device_, *written.image_desc, places[parity], setup_);
    written.images[parity] = read.images[parity ^ 1] = image.get();
  }
  reset({{current}, {current + 1}});
}

std::optional<Lifetime> FramePlan::shared_lifetime(std::uint32_t index) const {
  const Resource& resource = resources_[index];
  if (resource.is_made()) return std::nullopt;
  const auto& buffer = resource.buffer_desc;
  if (buffer && (buffer->memory != Memory::device || buffer->size < least_shared_bytes)) {
    return std::nullopt;
  }
  if (resource.image_desc && !resource.image_desc->mapped) return std::nullopt;
  const auto uses = first_and_last_use(index);
  // What comes from the frame before stays.
  if (!uses || uses->first_access != Access::write) return std::nullopt;
  Lifetime lifetime{.first = uses->first, .last = uses->last};
  // Something is left from the frame before where a pass is skipped.
  if (resource.image_desc && (keeps_images_ ? leaves_out(index) : reads_left_out(index))) {
    return std::nullopt;
  }
  const bool kept = std::ranges::find(kept_, index) != kept_.end();
  if (kept || (resource.image_desc && keeps_images_)) {
    lifetime.last = static_cast<std::uint32_t>(passes_.size());
  }
  const VkMemoryRequirements needed = requirements_of(device_, resource);
  lifetime.bytes = needed.size;
  lifetime.alignment = needed.alignment;
  lifetime.rare = is_undefined_when_skipped(index);
  return lifetime;
}

std::optional<FramePlan::Uses> FramePlan::first_and_last_use(std::uint32_t index) const {
  std::optional<Uses> found;
  for (std::uint32_t i = 0; i < passes_.size(); ++i) {
    for (const Use& use : passes_[i].all_uses()) {
      if (use.resource != index) continue;
      if (!found) found = Uses{i, i, use.access};
      found->last = i;
    }
  }
  return found;
}

std::vector<std::uint32_t> FramePlan::conditions_of_writing(std::uint32_t index) const {
  const auto uses = first_and_last_use(index);
  if (!uses) return {};
  const auto& first = passes_[uses->first].conditions;
  std::vector<std::uint32_t> needed;
  for (const std::uint32_t condition : first) {
    auto otherwise = first;
    std::ranges::replace(otherwise, condition, opposite_condition(condition));
    const bool always = std::ranges::any_of(passes_, [&](const Pass& pass) {
      return pass.conditions == otherwise &&
             std::ranges::any_of(pass.all_uses(), [&](const Use& use) {
               return use.resource == index && use.access == Access::write;
             });
    });
    if (!always) needed.push_back(condition);
  }
  return needed;
}

bool FramePlan::is_undefined_when_skipped(std::uint32_t index) const {
  return std::ranges::find(undefined_when_skipped_, index) != undefined_when_skipped_.end();
}

bool FramePlan::leaves_out(std::uint32_t index) const {
  return !conditions_of_writing(index).empty();
}

bool FramePlan::reads_left_out(std::uint32_t index) const {
  const auto uses = first_and_last_use(index);
  if (!uses || is_undefined_when_skipped(index)) return false;
  const bool history = resources_[index].part == Resource::Part::current;
  const auto is_it = [&](const Use& use) {
    return use.resource == index || (history && use.resource == index + 1);
  };
  const auto written = conditions_of_writing(index);
  return std::ranges::any_of(passes_, [&](const Pass& pass) {
    const auto all = pass.all_uses();
    return std::ranges::any_of(all, is_it) &&
           !std::ranges::all_of(written, [&](std::uint32_t condition) {
             return std::ranges::find(pass.conditions, condition) != pass.conditions.end();
           });
  });
}

// Until it is written, the image of this frame is free for what the passes before it need. That of
// the frame before is needed again when the frame is canceled.
Lifetime FramePlan::history_lifetime(std::uint32_t index) const {
  const auto passes = static_cast<std::uint32_t>(passes_.size());
  const bool current = resources_[index].part == Resource::Part::current;
  const std::uint32_t written = current ? index : index - 1;
  const auto uses = first_and_last_use(written);
  Lifetime lifetime{.last = passes};
  // What is left from a frame that does not write it stays.
  if (!uses || uses->first_access != Access::write) return lifetime;
  if (keeps_images_ ? leaves_out(written) : reads_left_out(written)) return lifetime;
  if (current) {
    lifetime.first = uses->first;
  } else if (cancelable_ < passes) {
    const auto read = first_and_last_use(index);
    const auto needed = static_cast<std::uint32_t>(cancelable_);
    lifetime.last = std::max(needed, read ? read->last + 1 : 1) - 1;
  }
  return lifetime;
}

// All histories lie in the same order in two blocks, one of which is what the frame writes, the
// other what it reads. What is written at the same time lies side by side: so does the memory that
// is free until then.
void FramePlan::make_histories() {
  if (!shares_memory_) return;
  std::vector<std::uint32_t> pending;
  for (std::uint32_t i = 0; i < resources_.size(); ++i) {
    if (resources_[i].part == Resource::Part::current && !resources_[i].is_made()) {
      pending.push_back(i);
    }
  }
  std::ranges::stable_sort(pending, {}, [&](std::uint32_t i) { return history_lifetime(i).first; });
  VkMemoryRequirements all{.size = 0, .alignment = 1, .memoryTypeBits = ~0u};
  for (const std::uint32_t i : pending) {
    const VkMemoryRequirements needed = requirements_of(device_, resources_[i]);
    const VkDeviceSize offset =
        (all.size + needed.alignment - 1) / needed.alignment * needed.alignment;
    history_offsets_.emplace_back(i, offset);
    all.size = offset + needed.size;
    all.memoryTypeBits &= needed.memoryTypeBits;
  }
  if (pending.empty()) return;
  if (all.size > most_block_bytes) {
    history_offsets_.clear();
    for (const std::uint32_t i : pending) make_history(i, {});
    return;
  }
  for (auto& block : history_blocks_) {
    block = std::make_shared<const MemoryBlock>(device_, all, "histories");
  }
  for (const auto& [i, offset] : history_offsets_) {
    make_history(i, {{{history_blocks_[0], offset}, {history_blocks_[1], offset}}});
  }
}

// An allocation takes a GPU's driver up to a millisecond, and there are more than a hundred
// resources. Images and buffers may not lie side by side.
void FramePlan::make_in_blocks() {
  if (shares_memory_) return;
  struct Group {
    std::vector<std::uint32_t> resources;
    std::vector<Lifetime> needed;  // one for each, two for a history and for what is doubled
    VkMemoryRequirements all{};
  };
  std::map<std::pair<bool, std::uint32_t>, Group> groups;  // images or buffers, types of memory
  for (std::uint32_t i = 0; i < resources_.size(); ++i) {
    const Resource& resource = resources_[i];
    if (resource.is_made() || resource.part == Resource::Part::previous) continue;
    const bool image = resource.image_desc.has_value();
    if (!image && resource.buffer_desc->memory != Memory::device) continue;
    const VkMemoryRequirements needed = requirements_of(device_, resource);
    Group& group = groups[{image, needed.memoryTypeBits}];
    group.resources.push_back(i);
    const bool two = resource.part == Resource::Part::current || resource.doubled;
    group.needed.insert(group.needed.end(), two ? 2 : 1,
                        {.bytes = needed.size, .alignment = needed.alignment});
    group.all = {0, std::max(group.all.alignment, needed.alignment), needed.memoryTypeBits};
  }
  for (auto& [kind, group] : groups) {
    const MemoryPlan plan = plan_memory(group.needed, most_gpu_block_bytes);
    std::vector<std::shared_ptr<const MemoryBlock>> blocks;
    for (const std::uint64_t bytes : plan.block_bytes) {
      group.all.size = bytes;
      blocks.push_back(
          std::make_shared<const MemoryBlock>(device_, group.all, "a frame's resources"));
    }
    auto next = plan.places.begin();
    const auto place = [&] {
      const MemoryPlan::Place& found = *next++;
      return MemoryPlace{blocks[found.block], found.offset};
    };
    for (const std::uint32_t i : group.resources) {
      const MemoryPlace even = place();
      if (resources_[i].part == Resource::Part::current) {
        make_history(i, {even, place()});
      } else {
        make(resources_[i], {even, resources_[i].doubled ? place() : even});
      }
    }
  }
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
  // Block 0 is what this frame writes, block 1 what the frame before has written.
  std::vector<FixedPlace> histories;
  for (const auto& [current, offset] : history_offsets_) {
    for (std::uint32_t part = 0; part < 2; ++part) {
      histories.push_back({history_lifetime(current + part), {part, offset}});
      histories.back().lifetime.bytes = requirements_of(device_, resources_[current]).size;
    }
  }
  const MemoryPlan plan = plan_memory(lifetimes, most_block_bytes, histories);
  std::vector<std::array<std::shared_ptr<const MemoryBlock>, 2>> blocks;
  for (const std::uint64_t bytes : plan.block_bytes) {
    if (!histories.empty() && blocks.size() < 2) {
      const std::size_t part = blocks.size();
      blocks.push_back({history_blocks_[part], history_blocks_[part ^ 1]});
      continue;
    }
    all.size = bytes;
    const auto block = std::make_shared<const MemoryBlock>(device_, all, "a frame's resources");
    blocks.push_back({block, block});
  }
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const auto& [block, offset] = plan.places[i];
    resources_[shared[i]].shares = true;
    make(resources_[shared[i]], {{{blocks[block][0], offset}, {blocks[block][1], offset}}});
  }
  for (Resource& resource : resources_) {
    if (!resource.is_made()) make(resource, {});
  }
}

void FramePlan::release_shared() {
  for (std::uint32_t i = 0; i < resources_.size(); ++i) {
    Resource& resource = resources_[i];
    const bool image = resource.part == Resource::Part::none && resource.image_desc;
    if (!std::exchange(resource.shares, false) && !image) continue;
    const auto uses = first_and_last_use(i);
    if (uses && uses->first_access == Access::write) resource.forget();
  }
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
    const auto& [even, odd] = resource.owned_images;
    count(even.get());
    if (odd != even) count(odd.get());
    const auto& [buffer, odd_buffer] = resource.owned_buffers;
    count(buffer.get());
    if (odd_buffer != buffer) count(odd_buffer.get());
  }
  return bytes;
}

}  // namespace heliograph::gpu
