#include "stream/encoders/exr_encoder.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cstring>
#include <stdexcept>

namespace heliograph::stream {
namespace {

/// Writes to memory.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}

  void write(const char bytes[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (end > file_.size()) file_.resize(end);
    std::memcpy(file_.data() + position_, bytes, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::vector<std::uint8_t> take() { return std::move(file_); }

 private:
  std::vector<std::uint8_t> file_;
  std::size_t position_ = 0;
};

std::vector<std::uint32_t> whole_numbers(const std::vector<float>& values) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(values.size());
  for (const float value : values) numbers.push_back(static_cast<std::uint32_t>(value));
  return numbers;
}

}  // namespace

std::vector<std::uint8_t> encode_exr(
    std::uint32_t width, std::uint32_t height, const std::vector<ExrChannel>& channels,
    const std::vector<std::pair<std::string, std::string>>& remarks) {
  Imf::Header header(static_cast<int>(width), static_cast<int>(height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, text] : remarks) {
    header.insert(name, Imf::StringAttribute(text));
  }
  Imf::FrameBuffer buffer;
  std::vector<std::vector<std::uint32_t>> counts;
  counts.reserve(channels.size());
  for (const ExrChannel& channel : channels) {
    if (channel.values.size() != std::size_t{width} * height) {
      throw std::runtime_error("OpenEXR: channel " + channel.name +
                               " does not have the size of the image");
    }
    const Imf::PixelType type = channel.counts ? Imf::UINT : Imf::FLOAT;
    header.channels().insert(channel.name, Imf::Channel(type));
    // The library reads through this pointer only.
    auto* first = reinterpret_cast<char*>(const_cast<float*>(channel.values.data()));
    if (channel.counts) {
      first = reinterpret_cast<char*>(counts.emplace_back(whole_numbers(channel.values)).data());
    }
    buffer.insert(channel.name, Imf::Slice(type, first, 4, std::size_t{4} * width));
  }
  MemoryStream memory;
  {
    constexpr int threads = 0;  // this one alone
    Imf::OutputFile file(memory, header, threads);
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(height));
  }
  return memory.take();
}

}  // namespace heliograph::stream
