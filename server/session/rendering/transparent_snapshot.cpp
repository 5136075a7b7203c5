#include "session/rendering/transparent_snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stream/encoders/png_encoder.hpp"

namespace heliograph::session {
namespace {

using nlohmann::json;
using protocol::Result;
using File = std::vector<std::uint8_t>;

/// As many steps as edges have.
constexpr std::uint32_t coverage_samples = 32;

constexpr std::size_t radiance_channels = 4;

/// Settings in which only the background sends light.
json without_light(const char* background) {
  const json off{{"enabled", false}};
  return {
      {"environment", {{"visible", true}}},
      {"background", {{"show", "color"}, {"color", background}}},
      {"lighting",
       {{"direct", false},
        {"environment_diffuse", false},
        {"environment_specular", false},
        {"emissive", false}}},
      {"shadows", off},
      {"specular", off},
      {"indirect", off},
      {"ambient", {{"occlusion", false}}},
      {"antialiasing", {{"temporal", false}, {"jitter", true}}},
      {"accumulation",
       {{"enabled", true},
        {"max_samples", coverage_samples},
        {"by_noise", false},
        {"blend_samples", 0}}},
      {"reference", {{"use", "off"}}},
  };
}

/// The values after the header of an npy file, format version 1.0.
std::span<const std::uint8_t> values_of(const File& npy) {
  constexpr std::size_t fixed = 10;
  if (npy.size() < fixed) return {};
  const std::size_t header = fixed + npy[8] + 256u * npy[9];
  return header > npy.size() ? std::span<const std::uint8_t>() : std::span(npy).subspan(header);
}

float green(std::span<const std::uint8_t> pixels, std::size_t pixel) {
  float value = 0.0f;
  std::memcpy(&value, &pixels[(radiance_channels * pixel + 1) * sizeof(float)], sizeof value);
  return value;
}

/// A color over black, sRGB, as it is without the black that covers the rest of the pixel.
std::uint8_t uncovered(std::uint8_t value, float coverage) {
  const float encoded = static_cast<float>(value) / 255.0f;
  const float light =
      encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
  const float full = std::min(light / coverage, 1.0f);
  const float result =
      full <= 0.0031308f ? 12.92f * full : 1.055f * std::pow(full, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.0f * result));
}

/// The size in the header of an npy file: "'shape': (270, 480, 3)".
std::optional<std::pair<std::uint32_t, std::uint32_t>> size_of(const File& npy) {
  const std::string_view text(reinterpret_cast<const char*>(npy.data()),
                              npy.size() - values_of(npy).size());
  const std::size_t shape = text.find("'shape': (");
  if (shape == std::string_view::npos) return std::nullopt;
  std::uint32_t height = 0, width = 0;
  const std::string rest(text.substr(shape));
  if (std::sscanf(rest.c_str(), "'shape': (%u, %u, 3)", &height, &width) != 2) return std::nullopt;
  return std::pair(width, height);
}

/// A PNG file of the colors over black (bytes) and the radiance over white and over black (floats).
/// Nothing where their sizes differ.
std::optional<File> combine_transparent(const File& colors, const File& over_white,
                                        const File& over_black) {
  const auto size = size_of(colors);
  if (!size || size_of(over_white) != size || size_of(over_black) != size) return std::nullopt;
  const std::size_t pixels = std::size_t{size->first} * size->second;
  const auto rgb = values_of(colors), white = values_of(over_white), black = values_of(over_black);
  const std::size_t floats = radiance_channels * pixels * sizeof(float);
  if (rgb.size() != 3 * pixels || white.size() != floats || black.size() != floats) {
    return std::nullopt;
  }
  std::vector<std::uint8_t> rgba(4 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float coverage = std::clamp(1.0f - (green(white, i) - green(black, i)), 0.0f, 1.0f);
    const auto alpha = static_cast<std::uint8_t>(std::lround(255.0f * coverage));
    for (std::size_t channel = 0; channel < 3 && alpha > 0; ++channel) {
      rgba[4 * i + channel] = uncovered(rgb[3 * i + channel], coverage);
    }
    rgba[4 * i + 3] = alpha;
  }
  return stream::encode_png({.width = size->first, .height = size->second, .rgba = rgba},
                            stream::Alpha::kept);
}

/// One capture after another, each of the state that was set before it.
class TransparentCapture : public std::enable_shared_from_this<TransparentCapture> {
 public:
  TransparentCapture(std::shared_ptr<Session> copy, CaptureRequest request)
      : copy_(std::move(copy)),
        own_settings_(copy_->settings().settings.value()),
        request_(std::move(request)) {}

  Result<void> begin() { return capture_coverage("#ffffff", over_white_); }

 private:
  Result<void> capture_coverage(const char* background, File& into) {
    CaptureRequest request{.buffer = "output.radiance",
                           .format = protocol::ImageFormat::npy,
                           .samples = coverage_samples};
    return capture(without_light(background), std::move(request), into);
  }

  Result<void> capture_colors() {
    json settings = own_settings_;
    settings["environment"]["visible"] = false;
    settings["view"]["buffer"] = "output";
    CaptureRequest request{.format = protocol::ImageFormat::npy, .samples = request_.samples};
    return capture(settings, std::move(request), colors_);
  }

  Result<void> capture(const json& settings, CaptureRequest request, File& into) {
    const auto patched = copy_->patch_settings(protocol::RawJson(settings), {});
    if (!patched) return patched.error();
    request.viewer = request_.viewer;
    request.done = [self = shared_from_this(), &into](Result<Capture> result) {
      if (!result) return self->request_.done(result.error());
      into = std::move(result->file);
      self->go_on(*result);
    };
    return copy_->captures().request_capture(std::move(request));
  }

  void go_on(Capture newest) {
    Result<void> accepted;
    if (!colors_.empty()) {
      auto file = combine_transparent(colors_, over_white_, over_black_);
      if (!file) return request_.done(protocol::error::internal());
      newest.file = *std::move(file);
      return request_.done(std::move(newest));
    }
    accepted = over_black_.empty() ? capture_coverage("#000000", over_black_) : capture_colors();
    if (!accepted) request_.done(accepted.error());
  }

  const std::shared_ptr<Session> copy_;
  const json own_settings_;
  CaptureRequest request_;
  File over_white_, over_black_, colors_;
};

}  // namespace

Result<void> request_transparent_capture(const std::shared_ptr<Session>& copy,
                                         CaptureRequest capture) {
  return std::make_shared<TransparentCapture>(copy, std::move(capture))->begin();
}

}  // namespace heliograph::session
