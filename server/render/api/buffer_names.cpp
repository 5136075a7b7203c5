#include "render/api/buffer_names.hpp"

#include <algorithm>
#include <array>

#include "protocol/json/suggestions.hpp"
#include "render/frame/compiled_frame.hpp"
#include "render/views/view_table.hpp"

namespace heliograph::render {
namespace {

// Of all passes, in the order of the frame; which of them there are follows from settings and
// scene.
constexpr std::array image_names{
    "gbuffer.normals",
    "gbuffer.base_color",
    "gbuffer.surface",
    "gbuffer.motion",
    "gbuffer.emissive",
    "gbuffer.depth_slope",
    "gbuffer.instance",
    "shadows.visibility",
    "ambient.visibility",
    "specular.radiance",
    "specular.half.radiance",
    "specular.half.directions",
    "denoise.guide",
    "denoise.reprojection",
    "visibility.raw",
    "visibility.percentiles",
    "visibility.memory",
    "visibility.moments",
    "visibility.history",
    "visibility.fast",
    "visibility.temporal",
    "visibility.blur.even",
    "visibility.blur.odd",
    "visibility.blur.half",
    "visibility.denoised",
    "specular.compressed",
    "specular.percentiles",
    "specular.memory",
    "specular.history",
    "specular.fast",
    "specular.temporal",
    "specular.blur.even",
    "specular.blur.odd",
    "specular.blur.half",
    "specular.denoised",
    "specular.expanded",
    "skybox",
    "hdr",
    "hdr_raw",
    "blended.radiance",
    "blended.behind",
    "blended.motion",
    "blended.mirrored",
    "blended.surface",
    "reference",
    "accumulated",
    "antialiased",
};

std::vector<std::string> all_names() {
  std::vector<std::string> names{std::string(picture_name), std::string(radiance_name)};
  for (const char* image : image_names) {
    names.emplace_back(image);
    for (std::string& aspect : aspects_of(image)) names.push_back(std::move(aspect));
  }
  return names;
}

}  // namespace

const std::vector<std::string>& buffer_names() {
  static const std::vector<std::string> names = all_names();
  return names;
}

protocol::Result<void> check_buffer_name(std::string_view name, const std::string& path) {
  const std::vector<std::string>& names = buffer_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return {};
  const std::vector<std::string_view> known(names.begin(), names.end());
  return protocol::error::invalid(path, "is not a buffer" + protocol::suggestion(name, known),
                                  "a name from frame.buffers");
}

}  // namespace heliograph::render
