#include "session/rendering/capture_content.hpp"

#include <array>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "render/api/octahedral.hpp"
#include "stream/encoders/jpeg_encoder.hpp"
#include "stream/encoders/npy_encoder.hpp"
#include "stream/encoders/png_encoder.hpp"
#include "stream/encoders/webp_encoder.hpp"

namespace heliograph::session {

using protocol::ImageFormat;
using protocol::Result;
using stream::ExrChannel;

namespace {

constexpr std::string_view output_buffer = "output";
constexpr std::string_view radiance_buffer = "output.radiance";
constexpr int lossy_quality = 90;

bool is_for_viewing(ImageFormat format) {
  return format == ImageFormat::png || format == ImageFormat::jpeg || format == ImageFormat::webp;
}

using Texel = const float*;

/// One channel; `read` gives its value of a texel.
template <class Read>
ExrChannel channel(std::string name, const render::FloatImage& image, Read read) {
  ExrChannel result{.name = std::move(name), .values = {}, .counts = image.integers};
  result.values.reserve(image.rgba.size() / 4);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    result.values.push_back(read(&image.rgba[i]));
  return result;
}

ExrChannel component(std::string name, const render::FloatImage& image, std::uint32_t index) {
  return channel(std::move(name), image, [index](Texel texel) { return texel[index]; });
}

std::vector<ExrChannel> plain_channels(const render::FloatImage& image) {
  if (image.channels == 1) return {component("Y", image, 0)};
  constexpr std::array names{"R", "G", "B", "A"};
  std::vector<ExrChannel> channels;
  for (std::uint32_t i = 0; i < image.channels; ++i) {
    channels.push_back(component(names[i], image, i));
  }
  return channels;
}

void add_normals(std::vector<ExrChannel>& channels, const render::FloatImage& image) {
  constexpr std::array names{"normals.X", "normals.Y", "normals.Z"};
  for (int axis = 0; axis < 3; ++axis) {
    channels.push_back(channel(names[static_cast<std::size_t>(axis)], image, [axis](Texel texel) {
      if (texel[0] > 1.5f) return 0.0f;  // background
      return render::octahedral_decode({texel[0], texel[1]})[axis];
    }));
  }
}

/// Buffers have 0 where nothing is.
float distance_or_infinity(float view_z) {
  return view_z > 0.0f ? view_z : std::numeric_limits<float>::infinity();
}

void show_background_depth(render::FloatImage& image, std::size_t index) {
  for (std::size_t i = index; i < image.rgba.size(); i += 4) {
    image.rgba[i] = distance_or_infinity(image.rgba[i]);
  }
}

void add_motion(std::vector<ExrChannel>& channels, const render::FloatImage& image) {
  const auto scaled = [](int index, float factor) {
    return [index, factor](Texel texel) { return texel[index] * factor; };
  };
  channels.push_back(channel("motion.X", image, scaled(0, static_cast<float>(image.width))));
  channels.push_back(channel("motion.Y", image, scaled(1, static_cast<float>(image.height))));
  channels.push_back(
      channel("depth.Z", image, [](Texel texel) { return distance_or_infinity(texel[3]); }));
}

void add_albedo(std::vector<ExrChannel>& channels, const render::FloatImage& image) {
  constexpr std::array names{"albedo.R", "albedo.G", "albedo.B"};
  for (std::uint32_t i = 0; i < 3; ++i) {
    channels.push_back(channel(names[i], image, [i](Texel texel) { return texel[i] * texel[i]; }));
  }
}

/// Radiance, with the G-buffer as layers where the frame has one.
Result<std::vector<ExrChannel>> layers(render::Renderer& renderer) {
  const auto radiance = renderer.capture(radiance_buffer);
  if (!radiance) return radiance.error();
  constexpr std::array names{"R", "G", "B"};
  std::vector<ExrChannel> channels;
  for (std::uint32_t i = 0; i < 3; ++i) channels.push_back(component(names[i], *radiance, i));
  if (const auto image = renderer.capture("gbuffer.motion")) add_motion(channels, *image);
  if (const auto image = renderer.capture("gbuffer.normals")) add_normals(channels, *image);
  if (const auto image = renderer.capture("gbuffer.base_color")) add_albedo(channels, *image);
  if (const auto image = renderer.capture("gbuffer.surface")) {
    channels.push_back(component("surface.roughness", *image, 0));
    channels.push_back(component("surface.metallic", *image, 1));
  }
  if (const auto image = renderer.capture("gbuffer.instance")) {
    channels.push_back(component("instance.id", *image, 0));
  }
  return channels;
}

std::vector<std::uint8_t> npy(const render::Frame& frame) {
  std::vector<std::byte> rgb;
  rgb.reserve(frame.rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < frame.rgba.size(); ++i) {
    if (i % 4 != 3) rgb.push_back(static_cast<std::byte>(frame.rgba[i]));
  }
  const std::array shape{frame.height, frame.width, 3u};
  return stream::encode_npy(stream::NpyElement::uint8, shape, rgb);
}

std::vector<std::uint8_t> npy(const render::FloatImage& image) {
  std::vector<std::uint32_t> shape{image.height, image.width};
  if (image.channels > 1) shape.push_back(image.channels);
  std::vector<float> values;
  std::vector<std::uint32_t> counts;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 >= image.channels) continue;
    if (image.integers) {
      counts.push_back(static_cast<std::uint32_t>(image.rgba[i]));
    } else {
      values.push_back(image.rgba[i]);
    }
  }
  if (image.integers) {
    return stream::encode_npy(stream::NpyElement::uint32, shape, std::as_bytes(std::span(counts)));
  }
  return stream::encode_npy(stream::NpyElement::float32, shape, std::as_bytes(std::span(values)));
}

std::vector<std::uint8_t> image_file(const render::Frame& frame, ImageFormat format,
                                     stream::Alpha alpha) {
  const stream::ImageView view{.width = frame.width, .height = frame.height, .rgba = frame.rgba};
  if (format == ImageFormat::npy) return npy(frame);
  if (format == ImageFormat::png) return stream::encode_png(view, alpha);
  if (format == ImageFormat::webp) return stream::encode_webp(view, lossy_quality, alpha);
  return stream::JpegEncoder().encode(view, lossy_quality, stream::ChromaSampling::full);
}

}  // namespace

bool is_complete_at_once(std::string_view buffer) {
  return buffer.starts_with("gbuffer.");
}

bool reads_other_buffers(std::string_view buffer, ImageFormat format) {
  if (buffer == radiance_buffer) return false;
  return buffer != output_buffer || format == ImageFormat::exr;
}

bool is_image_of_output(std::string_view buffer, ImageFormat format) {
  return buffer == output_buffer && is_for_viewing(format);
}

std::size_t estimated_file_bytes(std::string_view buffer, ImageFormat format, std::uint32_t width,
                                 std::uint32_t height) {
  constexpr std::size_t values = 4 * sizeof(float);  // the channels of a buffer, at most
  constexpr std::size_t layers = 15 * sizeof(float);
  const bool output = buffer == output_buffer;
  const std::size_t pixels = std::size_t{width} * height;
  switch (format) {
    case ImageFormat::png:
      return 3 * pixels;
    case ImageFormat::jpeg:
    case ImageFormat::webp:
      return pixels;
    case ImageFormat::npy:
      return (output ? 3 : values) * pixels;
    case ImageFormat::exr:  // is compressed to a half, about
      return (output ? layers : values) / 2 * pixels;
  }
  return 0;
}

Result<CaptureContent> read_content(render::Renderer& renderer, std::string_view buffer,
                                    ImageFormat format) {
  const bool as_image =
      is_for_viewing(format) || (format == ImageFormat::npy && buffer == output_buffer);
  if (as_image) {
    auto frame = renderer.capture_view(buffer);
    if (!frame) return frame.error();
    return CaptureContent{frame->width, frame->height, *std::move(frame)};
  }
  auto values = renderer.capture(buffer);
  if (!values) return values.error();
  if (buffer == "gbuffer.motion.view_z") show_background_depth(*values, 0);
  if (buffer == "gbuffer.motion") show_background_depth(*values, 3);
  const std::uint32_t width = values->width, height = values->height;
  if (format == ImageFormat::npy || buffer != output_buffer) {
    return CaptureContent{width, height, *std::move(values)};
  }
  auto channels = layers(renderer);
  if (!channels) return channels.error();
  return CaptureContent{width, height, *std::move(channels)};
}

std::vector<std::uint8_t> encode_content(const CaptureContent& content, ImageFormat format,
                                         stream::Alpha alpha) {
  if (const auto* frame = std::get_if<render::Frame>(&content.values)) {
    return image_file(*frame, format, alpha);
  }
  if (const auto* image = std::get_if<render::FloatImage>(&content.values)) {
    if (format == ImageFormat::npy) return npy(*image);
    return stream::encode_exr(content.width, content.height, plain_channels(*image));
  }
  return stream::encode_exr(content.width, content.height,
                            std::get<std::vector<ExrChannel>>(content.values));
}

}  // namespace heliograph::session
