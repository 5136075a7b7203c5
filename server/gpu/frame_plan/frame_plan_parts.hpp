#pragma once

// What a frame plan is made of; only its own sources and tests look in here.

#include "gpu/frame_plan/frame_plan.hpp"

namespace heliograph::gpu {

struct FramePlan::Resource {
  struct BufferDesc {
    VkDeviceSize size;
    VkBufferUsageFlags usage;
    Memory memory;
  };

  /// The part that a resource has in a history.
  enum class Part { none, current, previous };

  std::string name;
  Part part = Part::none;
  FrameSize size{0, 0};  // of an image
  // By parity of the frame; both the same except for histories, for what shares their memory, and
  // for what is doubled.
  std::array<const Image*, 2> images{};
  std::array<const Buffer*, 2> buffers{};
  std::array<std::shared_ptr<const Image>, 2> owned_images{};
  std::array<std::shared_ptr<const Buffer>, 2> owned_buffers{};
  std::optional<std::uint32_t> level;
  VkSampler sampler = VK_NULL_HANDLE;
  // What is still to be made by compile(), when it is known which resources share memory.
  std::optional<ImageDesc> image_desc;
  std::optional<BufferDesc> buffer_desc;
  bool shares = false;                     // memory with others
  bool doubled = false;                    // frames have their own in turn
  std::array<std::uint64_t, 2> written{};  // number of the last frame that did, if it is doubled

  bool is_made() const { return images[0] || buffers[0]; }
  void forget() {
    images = {};
    buffers = {};
    owned_images = {};
    owned_buffers = {};
  }
};

struct FramePlan::Pass {
  struct Attachment {
    std::uint32_t resource;
    std::optional<std::array<float, 4>> clear;
  };

  std::string name;
  ProgramSource make_program;        // when the plan is compiled, unless only the host runs
  const Program* program = nullptr;  // null: a host pass
  const RayProgram* rays = nullptr;  // `program`, where it is a ray tracing pipeline
  const ComputeProgram* in_a_crowd = nullptr;  // program_of() says when
  bool is_raster = false;
  VkExtent3D local_size{1, 1, 1};
  std::vector<Use> bound;      // in binding order
  std::vector<Use> listed;     // the same as given to bind(), with those that are absent
  const char* list = nullptr;  // which list that was
  std::vector<Attachment> colors;
  std::optional<Attachment> depth;
  std::optional<std::pair<std::uint32_t, VkDeviceSize>> indirect;
  FrameSize threads{0, 0};
  std::uint32_t side = 1;  // of the squares of pixels that it has one texel for
  std::uint32_t layers = 1;
  std::size_t constants_size = 0;
  std::function<void(std::byte*)> constants;
  std::function<void(VkCommandBuffer, VkPipelineLayout)> draw;
  std::function<void()> host;  // of a pass without a shader
  PassBuilder::HostRun kernel;
  const char* kernel_list = nullptr;
  std::size_t kernel_constants_size = 0;
  std::function<bool()> kernel_known;  // empty: in every frame
  std::function<bool()> condition;
  std::vector<std::uint32_t> conditions;  // numbers of those that it is made of

  std::array<VkDescriptorSet, 2> sets{};
  std::vector<std::uint32_t> doubled;  // resources that are, of those that it writes

  VkPipelineBindPoint bind_point() const {
    if (rays) return VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR;
    return is_raster ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE;
  }
  /// No frame runs a shader.
  bool is_host_only() const { return host || (kernel && !kernel_known); }
  bool runs_on_host() const { return host || (kernel && (!kernel_known || kernel_known())); }
  /// Everything the pass touches: bindings, attachments, indirect arguments.
  std::vector<Use> all_uses() const;
  /// What is wrong with the shader that runs in a crowd, if there is one; empty: nothing.
  std::string wrong_in_a_crowd() const;
};

}  // namespace heliograph::gpu
