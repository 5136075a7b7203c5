#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/messages/kinds.hpp"
#include "protocol/result.hpp"
#include "render/api/renderer.hpp"
#include "stream/encoders/exr_encoder.hpp"
#include "stream/encoders/image_view.hpp"

namespace heliograph::session {

/// What a file holds, read from a renderer; encoding it does not need the renderer.
///
/// png, jpeg and webp: the debug view of the buffer. npy: its values: `output` as uint8 of shape
/// (height, width, 3), sRGB; every other buffer as float32, or uint32 for integers, of shape
/// (height, width), or (height, width, channels) for more than one channel; view-space distances
/// are infinite in the background. exr: the values as
/// channels R, G, B, A, or Y for one channel; for `output` the radiance before exposure and tone
/// mapping, with the G-buffer as layers.
struct CaptureContent {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::variant<render::Frame, render::FloatImage, std::vector<stream::ExrChannel>> values;
};

/// Whether one frame shows all of the buffer: those of the G-buffer have no noise.
bool is_complete_at_once(std::string_view buffer);

/// Whether read_content() reads buffers that not every frame keeps: render::Renderer::keep_buffers.
bool reads_other_buffers(std::string_view buffer, protocol::ImageFormat format);

/// Whether such a file shows the output as viewers see it: neither its values nor another buffer.
bool is_image_of_output(std::string_view buffer, protocol::ImageFormat format);

/// Bytes of such a file, before its content is known: what images are rarely above, and arrays
/// never.
std::size_t estimated_file_bytes(std::string_view buffer, protocol::ImageFormat format,
                                 std::uint32_t width, std::uint32_t height);

/// Reads the buffer as of the last frame.
protocol::Result<CaptureContent> read_content(render::Renderer& renderer, std::string_view buffer,
                                              protocol::ImageFormat format);

/// Alpha is kept in png and webp only. @throws std::runtime_error when it cannot be encoded
std::vector<std::uint8_t> encode_content(const CaptureContent& content,
                                         protocol::ImageFormat format,
                                         stream::Alpha alpha = stream::Alpha::ignored);

}  // namespace heliograph::session
