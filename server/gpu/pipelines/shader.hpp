#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/device/device.hpp"
#include "gpu/memory/descriptors.hpp"

namespace heliograph::gpu {

/// SPIR-V words of one shader stage and the name of its source file.
struct ShaderBinary {
  std::string_view name;
  std::span<const std::uint32_t> words;
};

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
};

struct Reflection {
  std::vector<ShaderBinding> bindings;  // by set, then binding
  std::uint32_t constants_size = 0;     // bytes of push constants
  VkExtent3D local_size{1, 1, 1};
};

/// @throws GpuError naming the shader when the words are not SPIR-V
Reflection reflect(const ShaderBinary& shader);

/// Descriptor sets that the caller binds, by set number, checked against what the shader declares.
using SharedLayouts = std::map<std::uint32_t, const DescriptorLayout*>;

/// The set that a frame plan fills from a pass's declared reads and writes.
inline constexpr std::uint32_t pass_set = 1;

/// What compute and raster programs have in common: layout, reflection, pipeline.
class Program {
 public:
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  const std::string& name() const { return name_; }
  VkPipeline pipeline() const { return pipeline_; }
  VkPipelineLayout layout() const { return layout_; }
  VkDescriptorSetLayout pass_set_layout() const { return pass_layout_; }
  /// Bindings of the pass set, ascending.
  const std::vector<ShaderBinding>& pass_bindings() const { return pass_bindings_; }
  std::uint32_t constants_size() const { return constants_size_; }
  VkShaderStageFlags stages() const { return stages_; }
  bool uses_set(std::uint32_t set) const;

 protected:
  Program(const Device& device, std::string name) : device_(device), name_(std::move(name)) {}
  void create_layout(std::span<const Reflection> stages, VkShaderStageFlags flags,
                     const SharedLayouts& shared);

  const Device& device_;
  std::string name_;
  VkPipeline pipeline_ = VK_NULL_HANDLE;

 private:
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

 private:
  VkExtent3D local_size_{};
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
};

}  // namespace heliograph::gpu
