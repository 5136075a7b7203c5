#include "session/rendering/transparent_snapshot.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "session/event_log.hpp"
#include "session/rendering/transparency.hpp"
#include "stream/encoders/png_encoder.hpp"

namespace heliograph::session {
namespace {

using nlohmann::json;
using protocol::Result;
using File = std::vector<std::uint8_t>;

constexpr std::size_t radiance_channels = 4;

/// The values after the header of an npy file, format version 1.0.
std::span<const std::uint8_t> values_of(const File& npy) {
  constexpr std::size_t fixed = 10;
  if (npy.size() < fixed) return {};
  const std::size_t header = fixed + npy[8] + 256u * npy[9];
  return header > npy.size() ? std::span<const std::uint8_t>() : std::span(npy).subspan(header);
}

std::vector<float> radiance_of(const File& npy) {
  const auto bytes = values_of(npy);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
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

/// A PNG file of the colors over black (bytes) and the radiance over white and over black (floats),
/// with marks drawn over it. Nothing where their sizes differ.
std::optional<File> combine_transparent(const File& colors, const File& over_white,
                                        const File& over_black, const stream::ImageMarks& marks) {
  const auto size = size_of(colors);
  if (!size || size_of(over_white) != size || size_of(over_black) != size) return std::nullopt;
  const std::size_t pixels = std::size_t{size->first} * size->second;
  const auto rgb = values_of(colors);
  const auto white = radiance_of(over_white), black = radiance_of(over_black);
  const std::size_t floats = radiance_channels * pixels;
  if (rgb.size() != 3 * pixels || white.size() != floats || black.size() != floats) {
    return std::nullopt;
  }
  std::vector<std::uint8_t> rgba(4 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    std::copy_n(rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
  put_background(rgba, coverage_of(white, black), std::nullopt);
  stream::draw_marks(rgba, size->first, size->second, marks, stream::Alpha::kept);
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

  Result<void> begin() { return capture_coverage(CoverageBackground::white, over_white_); }

 private:
  Result<void> capture_coverage(CoverageBackground background, File& into) {
    CaptureRequest request{.buffer = "output.radiance",
                           .format = protocol::ImageFormat::npy,
                           .samples = coverage_samples};
    return capture(coverage_settings(background), std::move(request), into);
  }

  Result<void> capture_colors() {
    json settings = own_settings_;
    settings["environment"]["visible"] = false;
    settings["view"]["buffer"] = "output";
    CaptureRequest request{.format = protocol::ImageFormat::npy, .samples = request_.samples};
    if (request_.marks != CaptureMarks::none) request.marks = CaptureMarks::listed;
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
      auto file = combined(newest.marks);
      if (!file) return request_.done(protocol::error::internal());
      newest.file = *std::move(file);
      return request_.done(std::move(newest));
    }
    accepted = over_black_.empty() ? capture_coverage(CoverageBackground::black, over_black_)
                                   : capture_colors();
    if (!accepted) request_.done(accepted.error());
  }

  /// Nothing where it fails: the caller waits for an answer.
  std::optional<File> combined(const stream::ImageMarks& marks) const {
    try {
      return combine_transparent(colors_, over_white_, over_black_, marks);
    } catch (const std::exception& failure) {
      log_error({.session = copy_->name()},
                std::string("a transparent image could not be made: ") + failure.what());
      return std::nullopt;
    }
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
