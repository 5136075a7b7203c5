#include "scene/image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>

#include <array>
#include <cstring>
#include <optional>
#include <string>

#include "scene/image/exr_header.hpp"
#include "scene/image/image_size.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

/// A file in memory as an OpenEXR stream.
class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(std::span<const std::uint8_t> bytes) : IStream("image"), bytes_(bytes) {}

  bool read(char* target, int count) override {
    const auto requested = static_cast<std::size_t>(count);
    if (count < 0 || requested > bytes_.size() - position_) {
      throw ImportError("is truncated: its data ends early");
    }
    std::memcpy(target, bytes_.data() + position_, requested);
    position_ += requested;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw ImportError("is truncated: its data ends early");
    position_ = position;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

ImageSize check_header(const Imf::Header& header, std::uint64_t most_pixels) {
  if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE) {
    throw ImportError("has deep data, which is not supported");
  }
  if (Imf::hasEnvmap(header) && Imf::envmap(header) != Imf::ENVMAP_LATLONG) {
    throw ImportError("is a cube map; only latitude-longitude images are supported");
  }
  const auto& window = header.dataWindow();
  const auto& display = header.displayWindow();
  if (window.min != display.min || window.max != display.max) {
    throw ImportError("has a data window that differs from its display window");
  }
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  constexpr std::int64_t max_height = largest_image_side / 2;
  if (width < 1 || height < 1) throw ImportError("has no pixels");
  if (width > largest_image_side || height > max_height) {
    throw ImportError("is larger than " + std::to_string(largest_image_side) + " x " +
                      std::to_string(max_height) + " pixels");
  }
  if (static_cast<std::uint64_t>(width * height) > most_pixels) {
    throw ImportError("has more than " + std::to_string(most_pixels) + " pixels");
  }
  if (header.hasTileDescription()) {
    const auto& tiles = header.tileDescription();
    if (tiles.xSize > largest_image_side || tiles.ySize > largest_image_side) {
      throw ImportError("has tiles larger than an image may be");
    }
  }
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

/// The channel names of red, green and blue, or nullopt.
std::optional<std::array<std::string, 3>> find_colors(const Imf::ChannelList& channels) {
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B")) {
    return std::array<std::string, 3>{"R", "G", "B"};
  }
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const std::string name = channel.name();
    if (!name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - 1);
    if (channels.findChannel(layer + "G") && channels.findChannel(layer + "B")) {
      return std::array<std::string, 3>{layer + "R", layer + "G", layer + "B"};
    }
  }
  if (channels.findChannel("Y")) return std::array<std::string, 3>{"Y", "Y", "Y"};
  return std::nullopt;
}

void read_channels(Imf::InputPart& part, const std::array<std::string, 3>& names,
                   Environment& environment) {
  const auto& window = part.header().dataWindow();
  const std::size_t row = environment.width * sizeof(glm::vec3);
  Imf::FrameBuffer frame;
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && names[c] == names[0]) break;
    const Imf::Channel& channel = part.header().channels()[names[c].c_str()];
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      throw ImportError("has channels of different resolutions");
    }
    char* first = reinterpret_cast<char*>(&environment.radiance[0][c]);
    // The address of pixel (0, 0), which may be outside the data window.
    char* origin = first - std::int64_t{window.min.x} * std::int64_t{sizeof(glm::vec3)} -
                   std::int64_t{window.min.y} * static_cast<std::int64_t>(row);
    frame.insert(names[c], Imf::Slice(Imf::FLOAT, origin, sizeof(glm::vec3), row));
  }
  part.setFrameBuffer(frame);
  part.readPixels(window.min.y, window.max.y);
  if (names[0] != names[1]) return;
  for (glm::vec3& texel : environment.radiance) texel = glm::vec3(texel.x);
}

/// Luminance at every pixel and chroma at every fourth, combined by OpenEXR.
void read_luminance_and_chroma(std::span<const std::uint8_t> file, Environment& environment) {
  MemoryStream stream(file);
  Imf::RgbaInputFile input(stream);
  const auto& window = input.dataWindow();
  std::vector<Imf::Rgba> row(environment.width);
  for (std::uint32_t y = 0; y < environment.height; ++y) {
    const int line = window.min.y + static_cast<int>(y);
    input.setFrameBuffer(row.data() - window.min.x, 1, 0);
    input.readPixels(line, line);
    glm::vec3* target = &environment.radiance[std::size_t{y} * environment.width];
    for (const Imf::Rgba& pixel : row) *target++ = glm::vec3(pixel.r, pixel.g, pixel.b);
  }
}

}  // namespace

bool is_exr(std::span<const std::uint8_t> file) {
  constexpr std::array<std::uint8_t, 4> magic{0x76, 0x2f, 0x31, 0x01};
  return file.size() >= magic.size() && std::equal(magic.begin(), magic.end(), file.begin());
}

Environment decode_exr(std::span<const std::uint8_t> file, std::uint64_t most_pixels) {
  try {
    check_exr_attributes(file);
    MemoryStream stream(file);
    Imf::MultiPartInputFile input(stream, 0, false);
    const Imf::Header& header = input.header(0);
    const ImageSize size = check_header(header, most_pixels);
    const Imf::ChannelList& channels = header.channels();
    constexpr int most_channels = 256;
    int channel_count = 0;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) ++channel_count;
    if (channel_count > most_channels) throw ImportError("has more than 256 channels");
    const bool chroma = channels.findChannel("RY") && channels.findChannel("BY");
    const auto names = find_colors(channels);
    if (!names) throw ImportError("has neither color nor luminance channels");
    Environment environment{size.width, size.height, {}};
    environment.radiance.resize(std::size_t{size.width} * size.height);
    if (chroma && (*names)[0] == "Y") {
      read_luminance_and_chroma(file, environment);
    } else {
      Imf::InputPart part(input, 0);
      read_channels(part, *names, environment);
    }
    return environment;
  } catch (const ImportError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw ImportError(std::string("is damaged: ") + error.what());
  }
}

}  // namespace heliograph::scene
