#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/device/device.hpp"
#include "gpu/memory/descriptors.hpp"
#include "gpu/pipelines/program_registry.hpp"
#include "gpu/pipelines/shader_binary.hpp"

namespace heliograph::gpu {

/// One resource a shader declares.
struct ShaderBinding {
  std::uint32_t set = 0;
  std::uint32_t binding = 0;
  std::string name;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  std::uint32_t count = 1;
  bool reads = true;                      // not writeonly
  bool writes = true;                     // not readonly
  VkFormat format = VK_FORMAT_UNDEFINED;  // of a storage image
  bool integers = false;                  // what is read of a sampled image
};

struct Reflection {
  std::vector<ShaderBinding> bindings;  // by set, then binding
  std::uint32_t constants_size = 0;     // bytes of push constants
  VkExtent3D local_size{1, 1, 1};
};

/// @throws GpuError naming the shader when the words are not SPIR-V
Reflection reflect(const ShaderBinary& shader);

/// What of a shader differs from what the passes of another one were written for; empty: nothing.
std::string interface_difference(const Reflection& built, const Reflection& now);

/// Descriptor sets that the caller binds, by set number, checked against what the shader declares.
using SharedLayouts = std::map<std::uint32_t, const DescriptorLayout*>;

/// The set that a frame plan fills from a pass's declared reads and writes.
inline constexpr std::uint32_t pass_set = 1;

/// What compute, raster and ray programs have in common: layout, reflection, pipeline.
class Program {
 public:
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  virtual ~Program();

  const std::string& name() const { return name_; }
  VkPipeline pipeline() const { return pipeline_; }
  VkPipelineLayout layout() const { return layout_; }
  VkDescriptorSetLayout pass_set_layout() const { return pass_layout_; }
  /// Bindings of the pass set, ascending.
  const std::vector<ShaderBinding>& pass_bindings() const { return pass_bindings_; }
  std::uint32_t constants_size() const { return constants_size_; }
  VkShaderStageFlags stages() const { return stages_; }
  bool uses_set(std::uint32_t set) const;

  // For ShaderReload, which holds the lock of the device's program registry.
  /// As the program was built, in the order of make_pipeline.
  const std::vector<ShaderBinary>& embedded_stages() const { return embedded_stages_; }
  /// A pipeline of other code with the same layout, which the caller owns. @throws GpuError
  virtual VkPipeline make_pipeline(std::span<const ShaderBinary> stages) const = 0;
  /// Keeps a pipeline for use_newest; an earlier one that was not used is destroyed.
  void prepare(VkPipeline pipeline);
  /// Goes over to the prepared pipeline, if any. The one before stays until the program ends, since
  /// another thread may be recording it.
  virtual void use_newest();

 protected:
  Program(const Device& device, std::vector<ShaderBinary> stages, std::string_view name)
      : device_(device), name_(name), embedded_stages_(std::move(stages)) {}
  /// The code of all stages as it is now. The registry's lock is held.
  std::vector<ShaderBinary> current_stages() const;
  void create_layout(std::span<const Reflection> stages, VkShaderStageFlags flags,
                     const SharedLayouts& shared);

  const Device& device_;
  std::string name_;
  std::atomic<VkPipeline> pipeline_ = VK_NULL_HANDLE;

 private:
  std::vector<ShaderBinary> embedded_stages_;
  VkPipeline prepared_ = VK_NULL_HANDLE;
  std::vector<VkPipeline> retired_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout pass_layout_ = VK_NULL_HANDLE;
  VkShaderStageFlags stages_ = 0;
  std::vector<ShaderBinding> pass_bindings_;
  std::vector<std::uint32_t> sets_;
  std::uint32_t constants_size_ = 0;
};

class ComputeProgram : public Program {
 public:
  /// `specialization` is the value of the shader's constant 0, where it has one.
  /// @throws GpuError when a shared layout lacks or contradicts what the shader declares
  ComputeProgram(const Device& device, const ShaderBinary& shader, const SharedLayouts& shared = {},
                 std::optional<std::uint32_t> specialization = std::nullopt);
  VkExtent3D local_size() const { return local_size_; }
  VkPipeline make_pipeline(std::span<const ShaderBinary> stages) const final;

 private:
  VkExtent3D local_size_{};
  std::optional<std::uint32_t> specialization_;
  RegisteredProgram registered_;
};

struct RasterState {
  std::vector<VkFormat> color_formats;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  std::vector<VkVertexInputBindingDescription> vertex_bindings;
  std::vector<VkVertexInputAttributeDescription> vertex_attributes;
};

/// Triangles; reversed-Z depth test; cull mode and front face are dynamic.
class RasterProgram : public Program {
 public:
  RasterProgram(const Device& device, const ShaderBinary& vertex, const ShaderBinary& fragment,
                const RasterState& state, const SharedLayouts& shared = {});
  VkPipeline make_pipeline(std::span<const ShaderBinary> stages) const final;

 private:
  RasterState state_;
  RegisteredProgram registered_;
};

}  // namespace heliograph::gpu
