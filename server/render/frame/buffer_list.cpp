#include "render/frame/buffer_list.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "protocol/json/suggestions.hpp"
#include "render/api/buffer_names.hpp"
#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/compose/compose.hpp"
#include "render/passes/compose/skybox.hpp"
#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_indirect.hpp"
#include "render/passes/denoise/denoise_specular.hpp"
#include "render/passes/denoise/denoise_visibility.hpp"
#include "render/passes/denoise/reproject.hpp"
#include "render/passes/denoise/temporal.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/indirect/trace_indirect.hpp"
#include "render/passes/post/accumulate.hpp"
#include "render/passes/post/defocus.hpp"
#include "render/passes/post/filter_mean.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "render/passes/post/present.hpp"
#include "render/passes/post/temporal_antialias.hpp"
#include "render/passes/reference/reference.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/passes/visibility/trace_visibility.hpp"
#include "render/views/view_colors.hpp"

namespace heliograph::render {
namespace {

/// Appends the members of tables of descriptions.
template <class... Tables>
std::vector<BufferDescription> joined(const Tables&... tables) {
  std::vector<BufferDescription> all;
  const auto append = [&all](const auto& table) {
    using Members = std::array<BufferDescription, sizeof(table) / sizeof(BufferDescription)>;
    const auto members = std::bit_cast<Members>(table);
    all.insert(all.end(), members.begin(), members.end());
  };
  (append(tables), ...);
  return all;
}

/// Every buffer that a pass may write, in the order of the frame; which of them a frame has follows
/// from settings and scene.
const std::vector<BufferDescription>& all_buffers() {
  static const std::vector<BufferDescription> buffers = joined(
      present_buffers, gbuffer_buffers, reproject_buffers, sampling_plan_buffers,
      visibility_buffers, specular_buffers, denoise_visibility_buffers, visibility_temporal_buffers,
      half_visibility_buffers, visibility_half_atrous_buffers, visibility_atrous_buffers,
      denoise_specular_buffers, specular_temporal_buffers, specular_atrous_buffers,
      indirect_buffers, indirect_half_buffers, indirect_reproject_buffers,
      indirect_temporal_buffers, indirect_atrous_buffers, skybox_buffers, compose_buffers,
      blended_buffers, defocus_buffers, reference_buffers, accumulate_buffers,
      temporal_antialias_buffers, filter_mean_buffers, mean_weight_buffers);
  return buffers;
}

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const BufferDescription& buffer : all_buffers()) {
    names.emplace_back(buffer.name);
    for (std::string& aspect : aspect_names(buffer)) names.push_back(std::move(aspect));
  }
  return names;
}

}  // namespace

View find_view(std::string_view name) {
  for (const BufferDescription& buffer : all_buffers()) {
    if (buffer.name == name) return {&buffer, nullptr};
    if (!name.starts_with(buffer.name)) continue;
    for (const Aspect& aspect : buffer.aspects) {
      if (name.size() == buffer.name.size() + 1 + aspect.name.size() &&
          name[buffer.name.size()] == '.' && name.ends_with(aspect.name)) {
        return {&buffer, &aspect};
      }
    }
  }
  return {};
}

std::vector<std::string> aspect_names(const BufferDescription& buffer) {
  std::vector<std::string> names;
  for (const Aspect& aspect : buffer.aspects) {
    names.push_back(std::string(buffer.name) + "." + std::string(aspect.name));
  }
  return names;
}

FloatImage extract(const View& view, const FloatImage& buffer, const ViewContext& context,
                   glm::uvec2 origin) {
  if (!view.aspect) return buffer;
  FloatImage values{
      .width = buffer.width, .height = buffer.height, .channels = view.aspect->channels};
  values.rgba.reserve(buffer.rgba.size());
  for (std::uint32_t y = 0; y < buffer.height; ++y) {
    for (std::uint32_t x = 0; x < buffer.width; ++x) {
      const float* texel = &buffer.rgba[(std::size_t{y} * buffer.width + x) * 4];
      const glm::vec2 position(x + origin.x + 0.5f, y + origin.y + 0.5f);
      const glm::vec4 value =
          view.aspect->extract({{texel[0], texel[1], texel[2], texel[3]}, position}, context);
      values.rgba.insert(values.rgba.end(), {value.x, value.y, value.z, value.w});
    }
  }
  return values;
}

Frame visualise(std::string_view name, const FloatImage& values) {
  const View view = find_view(name);
  return colorize(view ? view.colors() : ViewColors::radiance, values);
}

const std::vector<std::string>& buffer_names() {
  static const std::vector<std::string> names = all_names();
  return names;
}

protocol::Result<void> check_buffer_name(std::string_view name, const std::string& path) {
  if (find_view(name)) return {};
  const std::vector<std::string>& names = buffer_names();
  const std::vector<std::string_view> known(names.begin(), names.end());
  return protocol::error::invalid(path, "is not a buffer" + protocol::suggestion(name, known),
                                  "a name from frame.buffers");
}

}  // namespace heliograph::render
