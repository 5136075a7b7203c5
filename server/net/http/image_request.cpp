#include "net/http/image_request.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "protocol/json/json_values.hpp"
#include "protocol/json/suggestions.hpp"
#include "protocol/limits.hpp"

namespace heliograph::net {
namespace {

using protocol::Result;

constexpr std::array image_kinds{
    ImageKind{"png", protocol::ImageFormat::png, "image/png"},
    ImageKind{"jpg", protocol::ImageFormat::jpeg, "image/jpeg"},
    ImageKind{"webp", protocol::ImageFormat::webp, "image/webp"},
    ImageKind{"npy", protocol::ImageFormat::npy, "application/x-npy"},
    ImageKind{"exr", protocol::ImageFormat::exr, "image/x-exr"},
};

/// "?fit" and "?fit=1", or "?fit=0".
Result<std::optional<bool>> flag_parameter(const HttpRequest& request, const std::string& name) {
  const std::optional<std::string> text = request.parameter(name);
  if (!text) return std::optional<bool>();
  if (text->empty() || *text == "1" || *text == "true") return std::optional(true);
  if (*text == "0" || *text == "false") return std::optional(false);
  return protocol::error::invalid(name, "must be 0 or 1");
}

}  // namespace

const ImageKind* image_kind(std::string_view extension) {
  const auto found = std::ranges::find(image_kinds, extension, &ImageKind::extension);
  return found == image_kinds.end() ? nullptr : &*found;
}

Result<void> check_parameters(const HttpRequest& request, std::vector<std::string_view> known) {
  // A balancer leads requests by these; see session_of().
  known.insert(known.end(), {"session", "enter"});
  for (const auto& [name, value] : request.query) {
    if (std::ranges::find(known, name) != known.end()) continue;
    return protocol::error::invalid(name, "is not a parameter" + protocol::suggestion(name, known),
                                    protocol::choices_text(known));
  }
  return {};
}

Result<ImageRequest> read_image_request(const HttpRequest& request,
                                        const session::SessionLimits& limits) {
  const auto known = check_parameters(request, {"buffer", "samples", "width", "height", "camera",
                                                "fit", "background", "transparent", "marks"});
  if (!known) return known.error();
  const auto samples = number_parameter(request, "samples", 1, protocol::max_samples_per_pixel);
  if (!samples) return samples.error();
  const auto width = number_parameter(request, "width", protocol::min_frame_size, limits.max_width);
  if (!width) return width.error();
  const auto height =
      number_parameter(request, "height", protocol::min_frame_size, limits.max_height);
  if (!height) return height.error();
  const auto fit = flag_parameter(request, "fit");
  if (!fit) return fit.error();
  const auto background = flag_parameter(request, "background");
  if (!background) return background.error();
  const auto transparent = flag_parameter(request, "transparent");
  if (!transparent) return transparent.error();
  const auto marks = flag_parameter(request, "marks");
  if (!marks) return marks.error();
  ImageRequest image;
  image.capture.buffer = request.parameter("buffer").value_or("output");
  image.capture.samples = *samples;
  if (marks->value_or(false)) image.capture.marks = session::CaptureMarks::drawn;
  image.view = {.width = *width,
                .height = *height,
                .camera = request.parameter("camera"),
                .fit = fit->value_or(false),
                .background = *background,
                .transparent = transparent->value_or(false)};
  return image;
}

}  // namespace heliograph::net
