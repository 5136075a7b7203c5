#include "protocol/messages/frame_header.hpp"

#include <algorithm>
#include <string>

namespace heliograph::protocol {
namespace {

constexpr std::array<std::uint8_t, 4> magic{'H', 'V', 'R', 'F'};

class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> bytes) : rest_(bytes) {}

  template <class Integer>
  void put(Integer value) {
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      rest_[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
    }
    rest_ = rest_.subspan(sizeof(Integer));
  }

 private:
  std::span<std::uint8_t> rest_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class Integer>
  void take(Integer& value) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      bits |= static_cast<std::uint64_t>(rest_[i]) << (8 * i);
    }
    value = static_cast<Integer>(bits);
    rest_ = rest_.subspan(sizeof(Integer));
  }

 private:
  std::span<const std::uint8_t> rest_;
};

/// Visits the members in wire order; writing and reading share this one list.
template <class Header, class Visitor>
void visit_members(Header& header, Visitor&& visit) {
  visit(header.version);
  visit(header.type);
  visit(header.codec);
  visit(header.flags);
  visit(header.header_bytes);
  visit(header.quality);
  visit(header.frame_seq);
  visit(header.render_id);
  visit(header.input_seq_echo);
  visit(header.state_rev);
  visit(header.width);
  visit(header.height);
  visit(header.x);
  visit(header.y);
  visit(header.full_width);
  visit(header.full_height);
  visit(header.render_start_us);
  visit(header.render_us);
  visit(header.encode_us);
  visit(header.queue_us);
  visit(header.sample_count);
}

struct FieldDescription {
  std::string_view name;
  std::string_view meaning;
};

/// In the order of visit_members().
constexpr auto field_descriptions = std::to_array<FieldDescription>({
    {"version", "1"},
    {"type", "1 frame, 2 tile, 3 buffer, 4 timing"},
    {"codec", "1 JPEG, 2 PNG, 3 WebP, 16 H.264, 17 AV1, 32 raw RGBA, 33 EXR"},
    {"flags", "1 key, 2 final, 4 first after a drop, 8 discontinuity"},
    {"header_bytes", "where the payload begins: 64 or more"},
    {"quality", "in the codec's units"},
    {"frame_seq", "counts per viewer; gaps are dropped frames"},
    {"render_id", "counts per session; equal values mean the same frame"},
    {"input_seq_echo", "newest seq of camera.set that this frame shows"},
    {"state_rev", "revision of the session that was rendered"},
    {"width", "of the payload, pixels"},
    {"height", "of the payload, pixels"},
    {"x", "of a tile in the full frame, pixels from the left"},
    {"y", "of a tile in the full frame, pixels from the top"},
    {"full_width", "of the full frame, pixels"},
    {"full_height", "of the full frame, pixels"},
    {"render_start_us", "server's monotonic clock at the start of rendering, microseconds"},
    {"render_us", "duration of rendering, microseconds"},
    {"encode_us", "duration of encoding, microseconds"},
    {"queue_us", "from the end of encoding to the start of writing, microseconds"},
    {"sample_count", "accumulated samples per pixel; 0: raster only"},
});

bool known(FrameType type) {
  return type >= FrameType::frame && type <= FrameType::timing;
}

bool known(FrameCodec codec) {
  switch (codec) {
    case FrameCodec::jpeg:
    case FrameCodec::png:
    case FrameCodec::webp:
    case FrameCodec::h264:
    case FrameCodec::av1:
    case FrameCodec::raw_rgba:
    case FrameCodec::exr:
      return true;
  }
  return false;
}

Error malformed(std::string path, std::string reason, std::string limit = {}) {
  return error::make(ErrorCode::parse_error, std::move(path), std::move(reason), std::move(limit));
}

Result<void> check_size(const FrameHeader& header) {
  if (header.type == FrameType::timing) return {};
  if (header.width == 0 || header.height == 0)
    return malformed("width", "is 0: the image is empty");
  if (header.x + header.width > header.full_width) {
    return malformed("full_width", "is smaller than x + width");
  }
  if (header.y + header.height > header.full_height) {
    return malformed("full_height", "is smaller than y + height");
  }
  return {};
}

}  // namespace

std::array<std::uint8_t, frame_header_bytes> encode_frame_header(const FrameHeader& header) {
  std::array<std::uint8_t, frame_header_bytes> bytes{};
  std::copy(magic.begin(), magic.end(), bytes.begin());
  Writer writer{std::span(bytes).subspan(magic.size())};
  visit_members(header, [&](const auto& member) { writer.put(member); });
  return bytes;
}

std::vector<FrameHeaderField> frame_header_fields() {
  std::vector<FrameHeaderField> fields{{"magic", 0, magic.size(), "the letters HVRF"}};
  std::size_t offset = magic.size();
  const FrameHeader header;
  visit_members(header, [&](const auto& member) {
    const FieldDescription& description = field_descriptions[fields.size() - 1];
    fields.push_back({description.name, offset, sizeof(member), description.meaning});
    offset += sizeof(member);
  });
  return fields;
}

Result<FrameHeader> decode_frame_header(std::span<const std::uint8_t> message) {
  if (message.size() < frame_header_bytes) {
    return malformed({}, "the message is shorter than a frame header", "64 bytes");
  }
  if (!std::equal(magic.begin(), magic.end(), message.begin())) {
    return malformed("magic", "is wrong: the message is not a frame", "HVRF");
  }
  FrameHeader header;
  Reader reader{message.subspan(magic.size(), frame_header_bytes - magic.size())};
  visit_members(header, [&](auto& member) { reader.take(member); });

  if (header.version != frame_header_version) {
    return malformed("version", "unknown version", std::to_string(frame_header_version));
  }
  if (!known(header.type)) return malformed("type", "unknown frame type");
  if (!known(header.codec)) return malformed("codec", "unknown codec");
  if (header.header_bytes < frame_header_bytes || header.header_bytes > message.size()) {
    return malformed("header_bytes", "places the payload outside the message");
  }
  const Result<void> size = check_size(header);
  if (!size) return size.error();
  return header;
}

}  // namespace heliograph::protocol
