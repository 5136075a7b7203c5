#pragma once

#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/memory/readback.hpp"
#include "gpu/pipelines/ray_pipeline.hpp"
#include "gpu/pipelines/shader.hpp"

namespace heliograph::gpu {

/// Handles of a plan's resources; cheap to copy, valid as long as the plan.
struct ImageRef {
  std::uint32_t index = ~0u;
};
struct BufferRef {
  std::uint32_t index = ~0u;
};

/// A signal with memory: what this frame writes is what the next frame reads.
struct History {
  ImageRef current;
  ImageRef previous;
};

/// What a pass had to touch: every image that it reads or writes counted whole, once for each, and
/// the entries of the stream it works on, whose count lies at the start of a buffer.
struct PassWork {
  std::string name;
  std::uint64_t image_bytes = 0;
  std::uint64_t entries = 0;
};

struct PassTiming {
  std::string name;
  bool host = false;
  float milliseconds = 0.0f;
};

class FramePlan;

/// One pass under construction. Reads and writes bind, in the order given, to the shader's pass
/// set in ascending binding order.
class PassBuilder {
 public:
  PassBuilder& read(ImageRef image) { return use_image(image, true, false); }
  PassBuilder& read(BufferRef buffer) { return use_buffer(buffer, true, false); }
  PassBuilder& write(ImageRef image) { return use_image(image, false, true); }
  PassBuilder& write(BufferRef buffer) { return use_buffer(buffer, false, true); }
  PassBuilder& read_write(ImageRef image) { return use_image(image, true, true); }
  PassBuilder& read_write(BufferRef buffer) { return use_buffer(buffer, true, true); }

  /// Push constants: a value, or a function that returns it anew every frame.
  template <typename Source>
  PassBuilder& constants(Source source) {
    if constexpr (std::is_invocable_v<Source>) {
      using Value = std::invoke_result_t<Source>;
      static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) <= 128);
      return set_constants(sizeof(Value), [source](std::byte* bytes) {
        const Value value = source();
        std::memcpy(bytes, &value, sizeof(Value));
      });
    } else {
      return constants([source] { return source; });
    }
  }

  /// Colour attachments in location order, cleared to `clear`, or kept when there is none.
  PassBuilder& color(ImageRef image, std::optional<std::array<float, 4>> clear);
  PassBuilder& depth(ImageRef image, float clear);

  /// One thread per pixel (or per element) and layer.
  PassBuilder& dispatch(VkExtent2D threads, std::uint32_t layers = 1);
  /// Groups from a VkDispatchIndirectCommand at `offset` of a buffer, which counts as read.
  PassBuilder& dispatch_indirect(BufferRef groups, VkDeviceSize offset);
  /// One invocation of a ray tracing pipeline's generation stage per element.
  PassBuilder& launch(std::uint32_t rays);
  /// Draw calls of a raster pass; the pipeline and shared sets are bound.
  PassBuilder& draw(std::function<void(VkCommandBuffer, VkPipelineLayout)> record);
  /// The pass is skipped in frames where this is false.
  PassBuilder& when(std::function<bool()> condition);
  /// What a person reads about the pass's outputs in the list of views.
  PassBuilder& describe(std::string text);

 private:
  friend class FramePlan;
  PassBuilder(FramePlan& plan, std::size_t pass) : plan_(plan), pass_(pass) {}
  PassBuilder& use_image(ImageRef image, bool reads, bool writes);
  PassBuilder& use_buffer(BufferRef buffer, bool reads, bool writes);
  PassBuilder& set_constants(std::size_t size, std::function<void(std::byte*)> fill);

  FramePlan& plan_;
  std::size_t pass_;
};

/// An ordered list of passes with what each reads and writes, from which barriers, timestamps,
/// labels, descriptor sets, the list of views and the history swap follow. Passes run in the order
/// declared. Images stay in GENERAL. A host pass runs on the processor between two submits, after
/// everything before it is done; on a CPU device it sees images and buffers through their mapping.
class FramePlan {
 public:
  FramePlan(const Device& device, VkExtent2D extent);
  ~FramePlan();
  FramePlan(const FramePlan&) = delete;
  FramePlan& operator=(const FramePlan&) = delete;

  VkExtent2D extent() const { return extent_; }
  const Device& device() const { return device_; }

  /// An image of the plan's extent, or of its own; mapped on CPU devices.
  ImageRef image(std::string name, VkFormat format, VkImageUsageFlags extra_usage = 0,
                 std::optional<VkExtent2D> extent = std::nullopt);
  /// Two images that change places after every frame; cleared to zero.
  History history(std::string name, VkFormat format, VkImageUsageFlags extra_usage = 0,
                  std::optional<VkExtent2D> extent = std::nullopt);
  BufferRef buffer(std::string name, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory);
  /// Resources owned elsewhere, which must outlive the plan.
  BufferRef import(const Buffer& buffer);
  /// The whole image for sampling (`level` absent, with `sampler`) or one level for storage.
  ImageRef import(const Image& image, std::optional<std::uint32_t> level, VkSampler sampler);

  /// A descriptor set of the caller's for every program that declares set `number`.
  void share_set(std::uint32_t number, VkDescriptorSet set);

  PassBuilder pass(std::string name, const ComputeProgram& program);
  PassBuilder pass(std::string name, const RayProgram& program);
  PassBuilder raster(std::string name, const RasterProgram& program);
  PassBuilder host(std::string name, std::function<void()> run);

  /// The one image that comes back to the host with every frame, through read().
  void read_back(ImageRef image) { read_back_ = image; }

  /// Checks every pass against its shader and derives everything else; call once after the last
  /// pass. @throws GpuError naming pass, binding and what is wrong
  void compile();

  /// Runs all passes, waits for them, reads the timers and swaps the histories.
  void execute();
  /// The frame that just ran, as read_back() asked for it: level 0, rows tightly packed.
  std::vector<std::uint8_t> read() const;
  const std::vector<PassTiming>& timings() const { return timings_; }
  /// The work behind the timings of the frame that just ran, in the same order. Copies counts back
  /// from the device: for measurements, not for every frame.
  std::vector<PassWork> work() const;

  const Image& get(ImageRef image) const;  // this frame's image of a history
  const Buffer& get(BufferRef buffer) const;
  /// The image written by the frame that just ran.
  const Image& latest(ImageRef image) const;

  struct View {
    std::string name;
    std::string description;
    ImageRef image;
  };
  const std::vector<View>& views() const { return views_; }

  void reset(const History& history);

  /// Names of passes in front of which a barrier stands, in order: what the tests look at.
  std::vector<std::string> barriers() const;

 private:
  friend class PassBuilder;
  struct Resource;
  struct Pass;

  std::uint32_t add(Resource resource);
  void check_pass(const Pass& pass) const;
  void derive_barriers();
  void make_descriptor_sets();
  void list_views();
  void record(const Pass& pass, VkCommandBuffer commands, std::uint32_t query);
  void record_raster(const Pass& pass, VkCommandBuffer commands);
  void bind(const Pass& pass, VkCommandBuffer commands);
  /// Whether every pass is a submit of its own, timed from outside: drivers for processors write
  /// timestamps while they record, as soon as anything was ever drawn.
  bool timed_by_clock() const;
  void begin(VkCommandBuffer commands) const;
  void submit(VkCommandBuffer commands) const;
  void read_timers();
  const Image& physical(std::uint32_t index, std::uint32_t parity) const;
  VkImageView physical_view(std::uint32_t index, std::uint32_t parity) const;

  const Device& device_;
  VkExtent2D extent_;
  std::vector<Resource> resources_;
  std::vector<Pass> passes_;
  std::vector<std::pair<std::uint32_t, VkDescriptorSet>> shared_sets_;
  std::unique_ptr<DescriptorPool> descriptor_pool_;
  Sampler default_sampler_;
  ImageRef read_back_;
  Readback readback_;
  VkCommandPool command_pool_ = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> commands_;
  VkQueryPool queries_ = VK_NULL_HANDLE;
  std::vector<PassTiming> timings_;
  std::vector<View> views_;
  std::uint32_t parity_ = 0;
  bool compiled_ = false;
};

}  // namespace heliograph::gpu
