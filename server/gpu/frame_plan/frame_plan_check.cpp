// What follows from declared reads and writes before anything runs: checks and views.

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include "gpu/frame_plan/frame_plan_parts.hpp"

namespace heliograph::gpu {
namespace {

const char* type_text(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "a storage image";
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
      return "a sampled image";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return "a storage buffer";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return "a uniform buffer";
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
      return "a texel buffer";
    default:
      return "something else";
  }
}

bool is_image(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ||
         type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

bool has_integers(VkFormat format) {
  return format == VK_FORMAT_R32_UINT || format == VK_FORMAT_R32G32_UINT ||
         format == VK_FORMAT_R32G32B32A32_UINT;
}

bool is_packed(VkFormat format) {
  return format == VK_FORMAT_R32G32B32A32_UINT || format == VK_FORMAT_R32G32_UINT;
}

/// What is wrong with binding an image or buffer called `given` there; empty: nothing.
std::string mismatch(const ShaderBinding& binding, const Image* image, const std::string& given,
                     bool reads, bool writes) {
  if (is_image(binding.type) != (image != nullptr)) {
    return std::string("is ") + type_text(binding.type) + ", given the " +
           (image ? "image" : "buffer") + " \"" + given + "\"";
  }
  if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE && binding.format != image->desc().format) {
    return std::string("has format ") + format_name(binding.format) + ", given \"" + given +
           "\" of format " + format_name(image->desc().format);
  }
  if (binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER &&
      binding.integers != has_integers(image->desc().format)) {
    return std::string("reads ") + (binding.integers ? "integers" : "floats") + ", given \"" +
           given + "\" of format " + format_name(image->desc().format);
  }
  if (binding.writes && !writes) {
    return "may be written by the shader, but \"" + given + "\" is declared as only read";
  }
  if (!binding.writes && writes) {
    return "is readonly in the shader, but \"" + given + "\" is declared as written";
  }
  const bool storage = binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE ||
                       binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  if (storage && binding.reads && !reads) {
    return "may be read by the shader, but \"" + given + "\" is declared as only written";
  }
  return {};
}

}  // namespace

std::vector<Use> FramePlan::Pass::all_uses() const {
  std::vector<Use> uses = bound;
  for (const auto& color : colors) {
    uses.push_back({color.resource, color.clear ? Access::write : Access::read_write});
  }
  if (depth) uses.push_back({depth->resource, Access::write});
  if (indirect) uses.push_back({indirect->first, Access::read});
  return uses;
}

std::string FramePlan::Pass::wrong_in_a_crowd() const {
  if (!in_a_crowd) return {};
  if (is_raster || rays) return "only compute shaders can be replaced in a crowd";
  const auto interface_of = [](const Program& shader, const VkExtent3D& groups) {
    return Reflection{shader.pass_bindings(), shader.constants_size(), groups};
  };
  const std::string difference = interface_difference(
      interface_of(*program, local_size), interface_of(*in_a_crowd, in_a_crowd->local_size()));
  if (difference.empty()) return {};
  return "the shader that runs in a crowd takes other bindings, constants or workgroups: " +
         difference;
}

void FramePlan::check_pass(const Pass& pass) const {
  const auto fail = [&](const std::string& what) {
    throw GpuError("pass \"" + pass.name + "\": " + what);
  };
  if (pass.kernel && pass.list != pass.kernel_list) {
    fail("its host kernel takes another list of bindings than the pass was given");
  }
  if (pass.kernel && pass.kernel_constants_size != pass.constants_size) {
    fail("its host kernel takes " + std::to_string(pass.kernel_constants_size) +
         " bytes of constants, given " + std::to_string(pass.constants_size));
  }
  if (!pass.program) return;
  const auto& bindings = pass.program->pass_bindings();
  for (std::size_t i = 0; i < std::min(bindings.size(), pass.bound.size()); ++i) {
    const auto& use = pass.bound[i];
    const Resource& resource = resources_[use.resource];
    const std::string wrong =
        mismatch(bindings[i], resource.images[0], resource.name, reads(use), writes(use));
    if (wrong.empty()) continue;
    fail("binding " + std::to_string(bindings[i].binding) + " \"" + bindings[i].name + "\" " +
         wrong);
  }
  if (pass.bound.size() < bindings.size()) {
    fail("nothing is given for binding " + std::to_string(bindings[pass.bound.size()].binding) +
         " \"" + bindings[pass.bound.size()].name + "\"");
  }
  if (pass.bound.size() > bindings.size()) {
    fail("\"" + resources_[pass.bound[bindings.size()].resource].name +
         "\" is given, but the shader has no binding for it");
  }
  if (pass.constants_size != pass.program->constants_size()) {
    fail("the shader takes " + std::to_string(pass.program->constants_size()) +
         " bytes of constants, given " + std::to_string(pass.constants_size));
  }
  const std::string wrong = pass.wrong_in_a_crowd();
  if (!wrong.empty()) fail(wrong);
  const bool dispatched = pass.threads.of(extent_).width > 0 || pass.indirect;
  if (!pass.is_raster && !dispatched) fail("it is never dispatched");
  if (pass.is_raster && !pass.draw) fail("it draws nothing");
  if (pass.is_raster && pass.colors.empty() && !pass.depth) fail("it has no attachment");
}

std::vector<std::string> FramePlan::barriers() const {
  std::vector<std::string> names;
  for (const std::uint32_t pass : order_.passes) {
    if (order_.barrier_before[pass]) names.push_back(passes_[pass].name);
  }
  return names;
}

void FramePlan::list_views() {
  std::set<std::uint32_t> listed;
  for (const Pass& pass : passes_) {
    for (const auto& use : pass.all_uses()) {
      const Resource& resource = resources_[use.resource];
      const Image* image = resource.images[0];
      if (!writes(use) || !image || is_depth(image->desc().format)) continue;
      if (is_packed(image->desc().format)) continue;  // nothing to see
      if (resource.level || !listed.insert(use.resource).second) continue;
      views_.push_back({resource.name, {use.resource}});
    }
  }
}

std::vector<PassWork> FramePlan::work() const {
  std::vector<PassWork> all;
  for (const Pass& pass : passes_) {
    PassWork work{.name = pass.name};
    for (const auto& use : pass.all_uses()) {
      const Resource& resource = resources_[use.resource];
      if (const Image* image = resource.images[0]) {
        const auto& desc = image->desc();
        const std::uint64_t texels = std::uint64_t{desc.extent.width} * desc.extent.height;
        work.image_bytes += texels * texel_bytes(desc.format) * (reads(use) + writes(use));
      } else if (work.entries == 0 && resource.name.ends_with(".ray_count")) {
        const auto count =
            download_buffer(device_, *resource.buffers[finished_], sizeof(std::uint32_t));
        std::uint32_t entries = 0;
        std::memcpy(&entries, count.data(), sizeof entries);
        work.entries = entries;
      }
    }
    all.push_back(std::move(work));
  }
  return all;
}

}  // namespace heliograph::gpu
