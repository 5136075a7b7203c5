#pragma once

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/messages/kinds.hpp"
#include "protocol/result.hpp"
#include "render/api/renderer.hpp"
#include "stream/encoders/exr_encoder.hpp"

namespace heliograph::session {

/// What goes into a file, read from a renderer; encoding it needs the renderer no more.
///
/// png and jpeg hold the buffer as a picture for people. npy holds its values: `output` as uint8 of
/// shape (height, width, 3), sRGB; every other buffer as float32, or uint32 where it counts, of
/// shape (height, width), or (height, width, channels) where it has several. exr holds the same as
/// channels R, G, B, A, or Y where there is one; but of `output` it holds the radiance before
/// exposure and tone mapping, with what is known of the surfaces as layers.
struct CaptureContent {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::variant<render::Frame, render::FloatImage, std::vector<stream::ExrChannel>> values;
};

/// The buffer as of the last frame.
protocol::Result<CaptureContent> read_content(render::Renderer& renderer, std::string_view buffer,
                                              protocol::ImageFormat format);

/// @throws std::runtime_error when it cannot be encoded
std::vector<std::uint8_t> encode_content(const CaptureContent& content,
                                         protocol::ImageFormat format);

}  // namespace heliograph::session
