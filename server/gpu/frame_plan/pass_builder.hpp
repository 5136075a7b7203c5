#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <span>
#include <type_traits>

#include "gpu/device/vulkan.hpp"
#include "gpu/frame_plan/bindings.hpp"
#include "gpu/frame_plan/frame_size.hpp"

namespace heliograph::gpu {

/// Most resources that one pass binds, and most bytes of push constants.
inline constexpr std::size_t most_bindings = 24;
inline constexpr std::size_t most_constants = 128;

class ComputeProgram;
class FramePlan;

/// One pass under construction. Its resources bind, in the order given, to the shader's pass set in
/// ascending binding order.
class PassBuilder {
 public:
  PassBuilder& read(ImageRef image) { return use({image.index, Access::read}); }
  PassBuilder& read(BufferRef buffer) { return use({buffer.index, Access::read}); }
  PassBuilder& write(ImageRef image) { return use({image.index, Access::write}); }
  PassBuilder& write(BufferRef buffer) { return use({buffer.index, Access::write}); }
  PassBuilder& read_write(ImageRef image) { return use({image.index, Access::read_write}); }
  PassBuilder& read_write(BufferRef buffer) { return use({buffer.index, Access::read_write}); }

  /// All resources of the pass by name: `.bind<BlurBindings>({.guide = ..., .signal = ...})`.
  template <template <class> class Bindings>
  PassBuilder& bind(const Bindings<Declared>& bindings) {
    static_assert(binding_count<Bindings> <= most_bindings);
    return use_list(&bindings_tag<Bindings>, uses_of<Bindings>(bindings));
  }

  /// Push constants: a value, or a function that is called in every frame.
  template <typename Source>
  PassBuilder& constants(Source source) {
    if constexpr (std::is_invocable_v<Source>) {
      using Value = std::invoke_result_t<Source>;
      static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) <= most_constants);
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

  /// Threads of each layer: each_pixel(), or as many as there are elements.
  PassBuilder& dispatch(FrameSize threads, std::uint32_t layers = 1);
  /// Groups from a VkDispatchIndirectCommand at `offset` of a buffer, which counts as read.
  PassBuilder& dispatch_indirect(BufferRef groups, VkDeviceSize offset);
  /// One invocation of a ray tracing pipeline's generation stage per element.
  PassBuilder& launch(std::uint32_t rays);
  /// Draw calls of a raster pass; the pipeline and shared sets are bound.
  PassBuilder& draw(std::function<void(VkCommandBuffer, VkPipelineLayout)> record);
  /// The pass is skipped in frames where this is false; empty: in none.
  PassBuilder& when(std::function<bool()> condition);

  /// In frames that begin while the device works on many others (Queues::is_crowded()), `program`
  /// runs instead: the same computation, with the same bindings, constants and workgroups.
  PassBuilder& in_a_crowd(const ComputeProgram& program);

  /// The same computation as the shader's by the host's processors, which a plan with host kernels
  /// runs in its place. `kernel` is a function or a lambda that takes a `const HostPass<...>&` of
  /// the list given to bind() and of the type given to constants().
  template <class Kernel>
  PassBuilder& host(Kernel kernel) {
    return run_on_host(std::function(std::move(kernel)));
  }
  /// A kernel whose job holds `inputs` besides the pass. They outlive the plan.
  template <class Job, class... Inputs>
  PassBuilder& host(void (*kernel)(const Job&), const Inputs&... inputs) {
    return host([kernel, &inputs...](const typename Job::Pass& pass) {
      kernel({pass, inputs...});
    });
  }
  /// Restricts host(): the shader runs where the kernel does not know the case, as decided
  /// when the pass is declared or in every frame.
  PassBuilder& host_when(bool known);
  PassBuilder& host_when(std::function<bool()> known);

 private:
  friend class FramePlan;
  /// Views of the list's resources, bytes of the constants, the size that is drawn.
  using HostRun =
      std::function<void(std::span<const HostView>, std::span<const std::byte>, VkExtent2D)>;

  PassBuilder(FramePlan& plan, std::size_t pass) : plan_(plan), pass_(pass) {}
  PassBuilder& use(Use use);
  PassBuilder& use_list(const char* tag, std::span<const Use> uses);
  PassBuilder& set_constants(std::size_t size, std::function<void(std::byte*)> fill);
  PassBuilder& set_host(const char* tag, std::size_t constants_size, HostRun run);

  template <template <class> class Bindings, class Constants>
  PassBuilder& run_on_host(std::function<void(const HostPass<Bindings, Constants>&)> kernel) {
    constexpr std::size_t size = std::is_empty_v<Constants> ? 0 : sizeof(Constants);
    return set_host(
        &bindings_tag<Bindings>, size,
        [kernel = std::move(kernel)](std::span<const HostView> views,
                                     std::span<const std::byte> constants, VkExtent2D extent) {
          HostViews<Bindings> all;
          std::copy_n(views.begin(), all.size(), all.begin());
          Constants value{};
          std::memcpy(&value, constants.data(), size);
          kernel({map_bindings<Bindings>(all), value, static_cast<int>(extent.width),
                  static_cast<int>(extent.height)});
        });
  }

  FramePlan& plan_;
  std::size_t pass_;
};

}  // namespace heliograph::gpu
