#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <memory>

#include "gpu/pipelines/shader.hpp"

namespace heliograph::gpu {
namespace {

struct ContextGuard {
  void operator()(spvc_context context) const { spvc_context_destroy(context); }
};
using Context = std::unique_ptr<spvc_context_s, ContextGuard>;

VkFormat storage_format(SpvImageFormat format) {
  switch (format) {
    case SpvImageFormatRgba32f:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case SpvImageFormatRgba16f:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    case SpvImageFormatRgba16:
      return VK_FORMAT_R16G16B16A16_UNORM;
    case SpvImageFormatRg16f:
      return VK_FORMAT_R16G16_SFLOAT;
    case SpvImageFormatRg32f:
      return VK_FORMAT_R32G32_SFLOAT;
    case SpvImageFormatR32f:
      return VK_FORMAT_R32_SFLOAT;
    case SpvImageFormatRgba8:
      return VK_FORMAT_R8G8B8A8_UNORM;
    case SpvImageFormatR32ui:
      return VK_FORMAT_R32_UINT;
    case SpvImageFormatRg32ui:
      return VK_FORMAT_R32G32_UINT;
    case SpvImageFormatRgba32ui:
      return VK_FORMAT_R32G32B32A32_UINT;
    default:
      return VK_FORMAT_UNDEFINED;
  }
}

/// Whether a resource carries a decoration, on the variable or on every member of its `block`.
bool decorated(spvc_compiler compiler, const spvc_reflected_resource& resource, bool block,
               SpvDecoration decoration) {
  if (spvc_compiler_has_decoration(compiler, resource.id, decoration)) return true;
  if (!block) return false;
  const SpvDecoration* found = nullptr;
  size_t count = 0;
  if (spvc_compiler_get_buffer_block_decorations(compiler, resource.id, &found, &count) !=
      SPVC_SUCCESS) {
    return false;
  }
  return std::find(found, found + count, decoration) != found + count;
}

VkDescriptorType sampled_type(spvc_compiler compiler, const spvc_reflected_resource& resource) {
  const auto type = spvc_compiler_get_type_handle(compiler, resource.base_type_id);
  return spvc_type_get_image_dimension(type) == SpvDimBuffer
             ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
             : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

/// Whether texels of a sampled image or a texel buffer are integers.
bool has_integers(spvc_compiler compiler, const spvc_reflected_resource& resource) {
  const auto image = spvc_compiler_get_type_handle(compiler, resource.base_type_id);
  const auto texel =
      spvc_compiler_get_type_handle(compiler, spvc_type_get_image_sampled_type(image));
  return spvc_type_get_basetype(texel) != SPVC_BASETYPE_FP32;
}

class Reflector {
 public:
  explicit Reflector(const ShaderBinary& shader) : name_(shader.name) {
    spvc_context context = nullptr;
    require(spvc_context_create(&context), "create a reflection context");
    context_.reset(context);
    spvc_parsed_ir ir = nullptr;
    require(spvc_context_parse_spirv(context, shader.words.data(), shader.words.size(), &ir),
            "parse the SPIR-V");
    require(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir,
                                         SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler_),
            "reflect");
    require(spvc_compiler_create_shader_resources(compiler_, &resources_), "list resources");
  }

  Reflection run() {
    collect(SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    collect(SPVC_RESOURCE_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    collect(SPVC_RESOURCE_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    collect(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    // From SPIR-V 1.6 on, texel buffers are images without a sampler.
    collect(SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
    std::sort(result_.bindings.begin(), result_.bindings.end(),
              [](const ShaderBinding& a, const ShaderBinding& b) {
                return std::pair(a.set, a.binding) < std::pair(b.set, b.binding);
              });
    for (const auto& block : list(SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) {
      const auto type = spvc_compiler_get_type_handle(compiler_, block.base_type_id);
      size_t size = 0;
      require(spvc_compiler_get_declared_struct_size(compiler_, type, &size), "size constants");
      result_.constants_size = static_cast<std::uint32_t>(size);
    }
    read_local_size();
    return result_;
  }

 private:
  void require(spvc_result result, const char* what) const {
    if (result == SPVC_SUCCESS) return;
    throw GpuError("shader " + std::string(name_) + ": could not " + what);
  }

  std::span<const spvc_reflected_resource> list(spvc_resource_type type) const {
    const spvc_reflected_resource* found = nullptr;
    size_t count = 0;
    require(spvc_resources_get_resource_list_for_type(resources_, type, &found, &count),
            "list resources");
    return {found, count};
  }

  void collect(spvc_resource_type kind, VkDescriptorType descriptor) {
    for (const auto& resource : list(kind)) {
      ShaderBinding binding;
      binding.set =
          spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationDescriptorSet);
      binding.binding = spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationBinding);
      binding.name = spvc_compiler_get_name(compiler_, resource.id);
      if (binding.name.empty()) binding.name = resource.name;
      binding.type = descriptor;
      if (kind == SPVC_RESOURCE_TYPE_SAMPLED_IMAGE) {
        binding.type = sampled_type(compiler_, resource);
      }
      if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) {
        // Of the view it is bound through.
        binding.format =
            has_integers(compiler_, resource) ? VK_FORMAT_R32_UINT : VK_FORMAT_R32G32B32A32_SFLOAT;
      } else if (kind == SPVC_RESOURCE_TYPE_SAMPLED_IMAGE) {
        binding.integers = has_integers(compiler_, resource);
      }
      const bool block = kind == SPVC_RESOURCE_TYPE_STORAGE_BUFFER;
      const bool writable = block || kind == SPVC_RESOURCE_TYPE_STORAGE_IMAGE;
      binding.writes = writable && !decorated(compiler_, resource, block, SpvDecorationNonWritable);
      binding.reads = !decorated(compiler_, resource, block, SpvDecorationNonReadable);
      if (kind == SPVC_RESOURCE_TYPE_STORAGE_IMAGE) {
        const auto type = spvc_compiler_get_type_handle(compiler_, resource.base_type_id);
        binding.format = storage_format(spvc_type_get_image_storage_format(type));
      }
      result_.bindings.push_back(std::move(binding));
    }
  }

  void read_local_size() {
    if (spvc_compiler_get_execution_model(compiler_) != SpvExecutionModelGLCompute) return;
    const auto axis = [&](unsigned index) {
      return spvc_compiler_get_execution_mode_argument_by_index(compiler_,
                                                                SpvExecutionModeLocalSize, index);
    };
    result_.local_size = {axis(0), axis(1), axis(2)};
  }

  std::string_view name_;
  Context context_;
  spvc_compiler compiler_ = nullptr;
  spvc_resources resources_ = nullptr;
  Reflection result_;
};

bool same_interface(const ShaderBinding& a, const ShaderBinding& b) {
  return a.set == b.set && a.binding == b.binding && a.type == b.type && a.count == b.count &&
         a.reads == b.reads && a.writes == b.writes && a.format == b.format &&
         a.integers == b.integers;
}

}  // namespace

Reflection reflect(const ShaderBinary& shader) {
  return Reflector(shader).run();
}

std::string interface_difference(const Reflection& built, const Reflection& now) {
  for (std::size_t i = 0; i < std::max(built.bindings.size(), now.bindings.size()); ++i) {
    const bool both = i < built.bindings.size() && i < now.bindings.size();
    if (both && same_interface(built.bindings[i], now.bindings[i])) continue;
    const ShaderBinding& which = i < now.bindings.size() ? now.bindings[i] : built.bindings[i];
    return "set " + std::to_string(which.set) + " binding " + std::to_string(which.binding) +
           " \"" + which.name + "\"";
  }
  if (built.constants_size != now.constants_size) return "the size of the push constants";
  const auto& a = built.local_size;
  const auto& b = now.local_size;
  if (a.width != b.width || a.height != b.height || a.depth != b.depth) return "the workgroup size";
  return {};
}

}  // namespace heliograph::gpu
