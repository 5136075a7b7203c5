#include "gpu/pipelines/shader.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "gpu/pipelines/shader_module.hpp"

namespace heliograph::gpu {
namespace {

void check_shared(const std::string& program, const ShaderBinding& binding,
                  const SharedLayouts& shared) {
  const std::string where = "shader " + program + ": set " + std::to_string(binding.set) +
                            " binding " + std::to_string(binding.binding) + " \"" + binding.name +
                            "\" ";
  const auto layout = shared.find(binding.set);
  if (layout == shared.end()) throw GpuError(where + "is in a set that no caller provides");
  const auto* provided = layout->second->find(binding.binding);
  if (!provided) throw GpuError(where + "is not in the layout \"" + layout->second->name() + "\"");
  if (provided->type != binding.type) {
    throw GpuError(where + "has another type than in the layout \"" + layout->second->name() +
                   "\"");
  }
}

VkDescriptorSetLayout make_pass_layout(const Device& device,
                                       const std::vector<ShaderBinding>& bindings) {
  std::vector<VkDescriptorSetLayoutBinding> infos;
  for (const auto& binding : bindings) {
    infos.push_back({binding.binding, binding.type, binding.count, VK_SHADER_STAGE_ALL, nullptr});
  }
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.bindingCount = static_cast<std::uint32_t>(infos.size());
  info.pBindings = infos.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout),
        "create a pass's descriptor set layout");
  return layout;
}

}  // namespace

Program::~Program() {
  for (const VkPipeline retired : retired_) vkDestroyPipeline(device_.handle(), retired, nullptr);
  vkDestroyPipeline(device_.handle(), prepared_, nullptr);
  vkDestroyPipeline(device_.handle(), pipeline_, nullptr);
  vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_.handle(), pass_layout_, nullptr);
}

bool Program::uses_set(std::uint32_t set) const {
  return std::find(sets_.begin(), sets_.end(), set) != sets_.end();
}

std::vector<ShaderBinary> Program::current_stages() const {
  std::vector<ShaderBinary> stages;
  for (const ShaderBinary& stage : embedded_stages_) {
    stages.push_back(device_.programs().current(stage));
  }
  return stages;
}

void Program::prepare(VkPipeline pipeline) {
  vkDestroyPipeline(device_.handle(), std::exchange(prepared_, pipeline), nullptr);
}

void Program::use_newest() {
  if (!prepared_) return;
  retired_.push_back(pipeline_.exchange(std::exchange(prepared_, VK_NULL_HANDLE)));
}

void Program::create_layout(std::span<const Reflection> stages, VkShaderStageFlags flags,
                            const SharedLayouts& shared) {
  stages_ = flags;
  for (const Reflection& stage : stages) {
    constants_size_ = std::max(constants_size_, stage.constants_size);
    for (const ShaderBinding& binding : stage.bindings) {
      if (!uses_set(binding.set)) sets_.push_back(binding.set);
      if (binding.set != pass_set) {
        check_shared(name_, binding, shared);
      } else if (std::none_of(pass_bindings_.begin(), pass_bindings_.end(),
                              [&](const auto& b) { return b.binding == binding.binding; })) {
        pass_bindings_.push_back(binding);
      }
    }
  }
  std::sort(pass_bindings_.begin(), pass_bindings_.end(),
            [](const auto& a, const auto& b) { return a.binding < b.binding; });
  pass_layout_ = make_pass_layout(device_, pass_bindings_);
  std::uint32_t count = pass_set + 1;
  for (const auto& [set, layout] : shared) count = std::max(count, set + 1);
  // Sets that no caller provides get the pass's own layout: valid, and never bound.
  std::vector<VkDescriptorSetLayout> layouts(count, pass_layout_);
  for (const auto& [set, layout] : shared) layouts[set] = layout->handle();
  const VkPushConstantRange range{flags, 0, constants_size_};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = count;
  info.pSetLayouts = layouts.data();
  info.pushConstantRangeCount = constants_size_ ? 1 : 0;
  info.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(device_.handle(), &info, nullptr, &layout_),
        "create a pipeline layout");
}

ComputeProgram::ComputeProgram(const Device& device, const ShaderBinary& shader,
                               const SharedLayouts& shared,
                               std::optional<std::uint32_t> specialization)
    : Program(device, {shader}, shader.name), specialization_(specialization) {
  const ProgramRegistry::Lock lock = device.programs().lock();
  const auto stages = current_stages();
  const Reflection reflection = reflect(stages[0]);
  local_size_ = reflection.local_size;
  create_layout({&reflection, 1}, VK_SHADER_STAGE_COMPUTE_BIT, shared);
  pipeline_ = make_pipeline(stages);
  registered_.enter(device.programs(), *this);
}

VkPipeline ComputeProgram::make_pipeline(std::span<const ShaderBinary> stages) const {
  const ShaderModule module(device_, stages[0]);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT);
  const VkSpecializationMapEntry entry{0, 0, sizeof(std::uint32_t)};
  VkSpecializationInfo constants{1, &entry, sizeof(std::uint32_t), nullptr};
  if (specialization_) {
    constants.pData = &*specialization_;
    info.stage.pSpecializationInfo = &constants;
  }
  info.layout = layout();
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device_.handle(), device_.pipeline_cache(), 1, &info, nullptr,
                                 &pipeline),
        ("create the pipeline " + name()).c_str());
  device_.name(VK_OBJECT_TYPE_PIPELINE, pipeline, name());
  return pipeline;
}

RasterProgram::RasterProgram(const Device& device, const ShaderBinary& vertex,
                             const ShaderBinary& fragment, const RasterState& state,
                             const SharedLayouts& shared)
    : Program(device, {vertex, fragment}, fragment.name), state_(state) {
  const ProgramRegistry::Lock lock = device.programs().lock();
  const auto stages = current_stages();
  const std::array reflections{reflect(stages[0]), reflect(stages[1])};
  create_layout(reflections, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, shared);
  pipeline_ = make_pipeline(stages);
  registered_.enter(device.programs(), *this);
}

VkPipeline RasterProgram::make_pipeline(std::span<const ShaderBinary> binaries) const {
  const ShaderModule vertex_module(device_, binaries[0]);
  const ShaderModule fragment_module(device_, binaries[1]);
  const std::array stages{vertex_module.stage(VK_SHADER_STAGE_VERTEX_BIT),
                          fragment_module.stage(VK_SHADER_STAGE_FRAGMENT_BIT)};

  VkPipelineVertexInputStateCreateInfo input{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  input.vertexBindingDescriptionCount = static_cast<std::uint32_t>(state_.vertex_bindings.size());
  input.pVertexBindingDescriptions = state_.vertex_bindings.data();
  input.vertexAttributeDescriptionCount =
      static_cast<std::uint32_t>(state_.vertex_attributes.size());
  input.pVertexAttributeDescriptions = state_.vertex_attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo samples{
      VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{
      VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = depth.depthWriteEnable = state_.depth_format != VK_FORMAT_UNDEFINED;
  depth.depthCompareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
  VkPipelineColorBlendAttachmentState opaque{};
  opaque.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                          VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  const std::vector attachments(state_.color_formats.size(), opaque);
  VkPipelineColorBlendStateCreateInfo blend{
      VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  blend.pAttachments = attachments.data();
  constexpr VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                               VK_DYNAMIC_STATE_CULL_MODE,
                                               VK_DYNAMIC_STATE_FRONT_FACE};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 4;
  dynamic.pDynamicStates = dynamic_states;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(state_.color_formats.size());
  rendering.pColorAttachmentFormats = state_.color_formats.data();
  rendering.depthAttachmentFormat = state_.depth_format;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = 2;
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout();
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device_.handle(), device_.pipeline_cache(), 1, &info, nullptr,
                                  &pipeline),
        ("create the pipeline " + name()).c_str());
  device_.name(VK_OBJECT_TYPE_PIPELINE, pipeline, name());
  return pipeline;
}

}  // namespace heliograph::gpu
