#pragma once

// What a frame plan is made of; only its own sources and tests look in here.

#include "gpu/frame_plan/frame_plan.hpp"

namespace heliograph::gpu {

struct FramePlan::Resource {
  std::string name;
  // By parity of the frame; both the same except for histories.
  std::array<const Image*, 2> images{};
  const Buffer* buffer = nullptr;
  std::array<std::shared_ptr<const Image>, 2> owned_images{};
  std::shared_ptr<const Buffer> owned_buffer;
  std::optional<std::uint32_t> level;
  VkSampler sampler = VK_NULL_HANDLE;
};

struct FramePlan::Pass {
  struct Use {
    std::uint32_t resource;
    bool reads;
    bool writes;
  };
  struct Attachment {
    std::uint32_t resource;
    std::optional<std::array<float, 4>> clear;
  };

  std::string name;
  std::string description;
  const Program* program = nullptr;  // null: a host pass
  const RayProgram* rays = nullptr;  // `program`, where it is a ray tracing pipeline
  bool is_raster = false;
  VkExtent3D local_size{1, 1, 1};
  std::vector<Use> bound;  // in binding order
  std::vector<Attachment> colors;
  std::optional<Attachment> depth;
  std::optional<std::pair<std::uint32_t, VkDeviceSize>> indirect;
  VkExtent2D threads{};
  std::uint32_t layers = 1;
  std::size_t constants_size = 0;
  std::function<void(std::byte*)> constants;
  std::function<void(VkCommandBuffer, VkPipelineLayout)> draw;
  std::function<void()> host;
  std::function<bool()> condition;

  bool barrier_before = false;
  std::array<VkDescriptorSet, 2> sets{};

  VkPipelineBindPoint bind_point() const {
    if (rays) return VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR;
    return is_raster ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE;
  }
  /// Everything the pass touches: bindings, attachments, indirect arguments.
  std::vector<Use> all_uses() const;
};

}  // namespace heliograph::gpu
