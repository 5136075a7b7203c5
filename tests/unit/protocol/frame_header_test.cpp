#include "protocol/messages/frame_header.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace heliograph::protocol {
namespace {

FrameHeader example() {
  FrameHeader header;
  header.type = FrameType::tile;
  header.codec = FrameCodec::webp;
  header.flags = frame_flag::key | frame_flag::final;
  header.quality = 0x0150;
  header.frame_seq = 0x01020304;
  header.render_id = 0x11121314;
  header.input_seq_echo = 0x21222324;
  header.state_rev = 0x31323334;
  header.width = 0x0102;
  header.height = 0x0103;
  header.x = 0x0004;
  header.y = 0x0005;
  header.full_width = 0x0500;
  header.full_height = 0x02d0;
  header.render_start_us = 0x4142434445464748;
  header.render_us = 0x51525354;
  header.encode_us = 0x61626364;
  header.queue_us = 0x71727374;
  header.sample_count = 0x81828384;
  return header;
}

std::vector<std::uint8_t> bytes_of(const FrameHeader& header) {
  const auto bytes = encode_frame_header(header);
  return {bytes.begin(), bytes.end()};
}

TEST(FrameHeader, HasTheBytesOfTheProtocol) {
  const std::vector<std::uint8_t> golden{'H',  'V',  'R',  'F',   // 0 magic
                                         1,    2,    3,    3,     // 4 version, type, codec, flags
                                         64,   0,    0x50, 0x01,  // 8 header bytes, quality
                                         0x04, 0x03, 0x02, 0x01,  // 12 frame_seq
                                         0x14, 0x13, 0x12, 0x11,  // 16 render_id
                                         0x24, 0x23, 0x22, 0x21,  // 20 input_seq_echo
                                         0x34, 0x33, 0x32, 0x31,  // 24 state_rev
                                         0x02, 0x01, 0x03, 0x01,  // 28 width, height
                                         0x04, 0x00, 0x05, 0x00,  // 32 x, y
                                         0x00, 0x05, 0xd0, 0x02,  // 36 full size
                                         0x48, 0x47, 0x46, 0x45,
                                         0x44, 0x43, 0x42, 0x41,   // 40 render_start_us
                                         0x54, 0x53, 0x52, 0x51,   // 48 render_us
                                         0x64, 0x63, 0x62, 0x61,   // 52 encode_us
                                         0x74, 0x73, 0x72, 0x71,   // 56 queue_us
                                         0x84, 0x83, 0x82, 0x81};  // 60 sample_count
  EXPECT_EQ(bytes_of(example()), golden);
}

TEST(FrameHeader, FieldsCoverItWithoutGapsAndAreWhereTheyAreWritten) {
  std::size_t end = 0;
  for (const FrameHeaderField& field : frame_header_fields()) {
    EXPECT_EQ(field.offset, end) << field.name;
    EXPECT_FALSE(field.meaning.empty()) << field.name;
    end += field.bytes;
  }
  EXPECT_EQ(end, frame_header_bytes);
  // Each of these has a value of its own in the example.
  const std::vector<std::uint8_t> bytes = bytes_of(example());
  const auto first_byte = [&](std::string_view name) {
    const auto fields = frame_header_fields();
    const auto found = std::ranges::find(fields, name, &FrameHeaderField::name);
    return found == fields.end() ? -1 : int{bytes[found->offset]};
  };
  EXPECT_EQ(first_byte("magic"), 'H');
  EXPECT_EQ(first_byte("header_bytes"), 64);
  EXPECT_EQ(first_byte("frame_seq"), 0x04);
  EXPECT_EQ(first_byte("input_seq_echo"), 0x24);
  EXPECT_EQ(first_byte("y"), 0x05);
  EXPECT_EQ(first_byte("full_height"), 0xd0);
  EXPECT_EQ(first_byte("render_start_us"), 0x48);
  EXPECT_EQ(first_byte("sample_count"), 0x84);
}

TEST(FrameHeader, SurvivesTheRoundTrip) {
  std::vector<std::uint8_t> message = bytes_of(example());
  message.insert(message.end(), 100, 0xff);  // the payload is ignored
  const Result<FrameHeader> decoded = decode_frame_header(message);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(*decoded, example());
}

TEST(FrameHeader, ReadersAcceptALongerHeader) {
  FrameHeader longer = example();
  longer.header_bytes = 72;
  std::vector<std::uint8_t> message = bytes_of(longer);
  message.resize(72);
  EXPECT_TRUE(decode_frame_header(message));
  message.resize(71);
  EXPECT_FALSE(decode_frame_header(message));
}

TEST(FrameHeader, IsRefusedWhenTruncated) {
  const std::vector<std::uint8_t> whole = bytes_of(example());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> part(whole.begin(), whole.begin() + static_cast<long>(size));
    EXPECT_FALSE(decode_frame_header(part)) << size;
  }
}

struct Damage {
  std::size_t offset;
  std::uint8_t value;
  const char* path;
};

void PrintTo(const Damage& damage, std::ostream* out) {
  *out << damage.path;
}

class FrameHeaderRefuses : public testing::TestWithParam<Damage> {};

TEST_P(FrameHeaderRefuses, NamesTheInvalidField) {
  std::vector<std::uint8_t> message = bytes_of(example());
  message[GetParam().offset] = GetParam().value;
  const Result<FrameHeader> decoded = decode_frame_header(message);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, ErrorCode::parse_error);
  EXPECT_EQ(decoded.error().path, GetParam().path);
}

INSTANTIATE_TEST_SUITE_P(
    Fields, FrameHeaderRefuses,
    testing::Values(Damage{0, 'h', "magic"}, Damage{3, 'V', "magic"}, Damage{4, 0, "version"},
                    Damage{4, 2, "version"}, Damage{5, 0, "type"}, Damage{5, 5, "type"},
                    Damage{6, 0, "codec"}, Damage{6, 4, "codec"}, Damage{6, 255, "codec"},
                    Damage{8, 63, "header_bytes"}, Damage{9, 255, "header_bytes"},
                    Damage{29, 255, "full_width"}, Damage{33, 255, "full_width"},
                    Damage{39, 0, "full_height"}));

TEST(FrameHeaderRefuses, AnEmptyImageExceptInTimingMessages) {
  FrameHeader header = example();
  header.width = 0;
  EXPECT_FALSE(decode_frame_header(bytes_of(header)));
  header.type = FrameType::timing;
  EXPECT_TRUE(decode_frame_header(bytes_of(header)));
}

}  // namespace
}  // namespace heliograph::protocol
