#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "protocol/result.hpp"
#include "stream/picture_view.hpp"

namespace heliograph::session {

enum class CaptureFormat { png, jpeg };

/// One buffer as a file.
struct Capture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;
  std::vector<std::uint8_t> file;
};

struct CaptureRequest {
  std::string buffer = "output";
  CaptureFormat format = CaptureFormat::png;
  /// Samples to wait for; absent: all that accumulation gives.
  std::optional<std::uint32_t> samples;
  /// Called once, on any thread.
  std::function<void(protocol::Result<Capture>)> done;
};

/// @throws std::runtime_error when the picture cannot be encoded
std::vector<std::uint8_t> encode_capture(const stream::PictureView& picture, CaptureFormat format);

}  // namespace heliograph::session
