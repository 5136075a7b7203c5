#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "protocol/messages/kinds.hpp"

namespace heliograph::render {

struct PassTime {
  std::string name;
  protocol::PassKind kind;  // device or host
  float milliseconds;
};

/// The work of a pass in the last frame: bytes of the images that it reads and writes, and the rays
/// of its stream (0: it has none).
struct PassWork {
  std::string name;
  std::uint64_t image_bytes;
  std::uint64_t rays;
};

/// Four floats a pixel, row 0 on top; what the channels mean is the buffer's description.
struct FloatImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> rgba{};
  std::uint32_t channels = 4;  // the first so many of the four are the buffer's
  bool integers = false;       // whole numbers from 0
};

/// The value of one buffer at one pixel.
struct BufferValue {
  std::string name;
  std::vector<float> channels;
  std::string unit;  // empty: plain numbers, or channels of different kinds
};

/// The surface at one point of the frame, in world space, metres.
struct SurfacePoint {
  std::uint32_t instance;  // of the scene
  glm::vec3 position;
  glm::vec3 normal;  // of the triangle, toward the camera
  float distance;    // from the eye; along the view for cameras without perspective
};

struct BufferInfo {
  std::string name;
  std::string description;
};

/// What the radiance cache of one view takes.
struct CacheUse {
  std::uint32_t cells = 0;
  std::uint32_t most_cells = 0;
  std::uint64_t bytes = 0;  // allocated, however few cells there are
};

/// What the device makes of a frame. Of a smaller image each pixel is the mean of its area.
struct JpegRequest {
  int quality = 80;   // 1 to 100
  int percent = 100;  // of the frame's width and height, 1 to 100

  bool operator==(const JpegRequest&) const = default;
};

/// A frame that the device has encoded.
struct DeviceJpeg {
  JpegRequest made;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> bytes;  // a file, with chroma at half the size; empty: there is none
};

/// One rendered frame, ready for an encoder.
struct Frame {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;  // sRGB, alpha 255, row 0 on top, tightly packed; may be absent
                                   // where there is a JPEG
  DeviceJpeg jpeg;                 // if Renderer::request_jpeg() asked for it
  std::uint32_t samples = 0;       // accumulated in this frame
  bool converged = false;          // another frame would show the same
  bool new_buffers = false;        // buffers() may differ from those of the frame before
  float milliseconds = 0.0f;       // whole frame, wall clock
  std::vector<PassTime> passes;
  CacheUse radiance_cache;  // nothing where indirect light is off
};

}  // namespace heliograph::render
