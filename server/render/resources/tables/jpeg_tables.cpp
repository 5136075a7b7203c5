#include "render/resources/tables/jpeg_tables.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace heliograph::render {
namespace {

constexpr std::array<std::uint8_t, 128> base_quantisation{
    16, 11, 10, 16, 24,  40,  51,  61,   // luma
    12, 12, 14, 19, 26,  58,  60,  55,   //
    14, 13, 16, 24, 40,  57,  69,  56,   //
    14, 17, 22, 29, 51,  87,  80,  62,   //
    18, 22, 37, 56, 68,  109, 103, 77,   //
    24, 35, 55, 64, 81,  104, 113, 92,   //
    49, 64, 78, 87, 103, 121, 120, 101,  //
    72, 92, 95, 98, 112, 100, 103, 99,   //
    17, 18, 24, 47, 99,  99,  99,  99,   // chroma
    18, 21, 26, 66, 99,  99,  99,  99,   //
    24, 26, 56, 99, 99,  99,  99,  99,   //
    47, 66, 99, 99, 99,  99,  99,  99,   //
    99, 99, 99, 99, 99,  99,  99,  99,   //
    99, 99, 99, 99, 99,  99,  99,  99,   //
    99, 99, 99, 99, 99,  99,  99,  99,   //
    99, 99, 99, 99, 99,  99,  99,  99};

/// How many codes have 1 to 16 bits, and what they stand for, in ascending order.
struct HuffmanTable {
  std::uint8_t id;  // as in a file: class and number
  std::array<std::uint8_t, 16> lengths;
  std::span<const std::uint8_t> symbols;
};

constexpr std::array<std::uint8_t, 12> categories{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
constexpr std::array<std::uint8_t, 162> luma_symbols{
    0x01, 0x02, 0x03, 0x00, 0x04, 0x11, 0x05, 0x12, 0x21, 0x31, 0x41, 0x06, 0x13, 0x51, 0x61,
    0x07, 0x22, 0x71, 0x14, 0x32, 0x81, 0x91, 0xa1, 0x08, 0x23, 0x42, 0xb1, 0xc1, 0x15, 0x52,
    0xd1, 0xf0, 0x24, 0x33, 0x62, 0x72, 0x82, 0x09, 0x0a, 0x16, 0x17, 0x18, 0x19, 0x1a, 0x25,
    0x26, 0x27, 0x28, 0x29, 0x2a, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44, 0x45,
    0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64,
    0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a, 0x83,
    0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97, 0x98, 0x99,
    0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4, 0xb5, 0xb6,
    0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3,
    0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe1, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8,
    0xe9, 0xea, 0xf1, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa};
constexpr std::array<std::uint8_t, 162> chroma_symbols{
    0x00, 0x01, 0x02, 0x03, 0x11, 0x04, 0x05, 0x21, 0x31, 0x06, 0x12, 0x41, 0x51, 0x07, 0x61,
    0x71, 0x13, 0x22, 0x32, 0x81, 0x08, 0x14, 0x42, 0x91, 0xa1, 0xb1, 0xc1, 0x09, 0x23, 0x33,
    0x52, 0xf0, 0x15, 0x62, 0x72, 0xd1, 0x0a, 0x16, 0x24, 0x34, 0xe1, 0x25, 0xf1, 0x17, 0x18,
    0x19, 0x1a, 0x26, 0x27, 0x28, 0x29, 0x2a, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44,
    0x45, 0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63,
    0x64, 0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a,
    0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97,
    0x98, 0x99, 0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4,
    0xb5, 0xb6, 0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca,
    0xd2, 0xd3, 0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7,
    0xe8, 0xe9, 0xea, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa};

constexpr HuffmanTable luma_dc{0x00, {0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0}, categories};
constexpr HuffmanTable luma_ac{
    0x10, {0, 2, 1, 3, 3, 2, 4, 3, 5, 5, 4, 4, 0, 0, 1, 125}, luma_symbols};
constexpr HuffmanTable chroma_dc{
    0x01, {0, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0}, categories};
constexpr HuffmanTable chroma_ac{
    0x11, {0, 2, 1, 2, 4, 4, 3, 4, 7, 5, 4, 4, 0, 1, 2, 119}, chroma_symbols};

/// Codes of one length follow each other; the next length goes on from twice the next code.
void write_codes(const HuffmanTable& table, std::uint32_t* by_symbol) {
  std::uint32_t code = 0;
  auto symbol = table.symbols.begin();
  for (std::uint32_t length = 1; length <= 16; ++length) {
    for (int i = 0; i < table.lengths[length - 1]; ++i) by_symbol[*symbol++] = code++ << 8 | length;
    code *= 2;
  }
}

/// The places of a block, 8 * row + column, from low to high frequencies along its diagonals.
std::array<std::uint8_t, 64> zigzag() {
  std::array<std::uint8_t, 64> places{};
  std::size_t next = 0;
  for (int diagonal = 0; diagonal < 15; ++diagonal) {
    for (int i = std::max(0, diagonal - 7); i <= std::min(diagonal, 7); ++i) {
      const int row = diagonal % 2 ? i : diagonal - i;
      places[next++] = static_cast<std::uint8_t>(8 * row + diagonal - row);
    }
  }
  return places;
}

class HeaderWriter {
 public:
  explicit HeaderWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  void write(std::initializer_list<std::uint32_t> values) {
    for (const std::uint32_t value : values) bytes_.push_back(static_cast<std::uint8_t>(value));
  }
  void write(std::span<const std::uint8_t> values) {
    bytes_.insert(bytes_.end(), values.begin(), values.end());
  }
  /// The marker of a segment and the length of what follows.
  void segment(std::uint32_t marker, std::size_t length) {
    write({0xff, marker});
    number(static_cast<std::uint32_t>(length + 2));
  }
  void number(std::uint32_t value) { write({value >> 8, value & 0xff}); }

 private:
  std::vector<std::uint8_t>& bytes_;
};

}  // namespace

shared::JpegTables jpeg_tables() {
  shared::JpegTables tables{};
  const auto places = zigzag();
  for (std::uint32_t i = 0; i < places.size(); ++i) tables.coding_order[places[i]] = i;
  std::copy(base_quantisation.begin(), base_quantisation.end(), tables.quantisation);
  write_codes(luma_dc, tables.dc_codes);
  write_codes(chroma_dc, tables.dc_codes + 16);
  write_codes(luma_ac, tables.ac_codes);
  write_codes(chroma_ac, tables.ac_codes + 256);
  tables.most_interval_bytes = shared::jpeg_slot_words * sizeof(std::uint32_t);
  return tables;
}

gpu::Buffer make_jpeg_tables(const gpu::Device& device) {
  const shared::JpegTables tables = jpeg_tables();
  return gpu::upload_buffer(device, "jpeg.tables", std::as_bytes(std::span(&tables, 1)),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
}

std::uint32_t jpeg_percent(int quality) {
  const auto q = static_cast<std::uint32_t>(std::clamp(quality, 1, 100));
  return q < 50 ? 5000 / q : 200 - 2 * q;
}

std::vector<std::uint8_t> jpeg_header(std::uint32_t width, std::uint32_t height, int quality) {
  std::vector<std::uint8_t> bytes;
  HeaderWriter out(bytes);
  out.write({0xff, 0xd8});
  // JFIF 1.1, square pixels, no thumbnail: colours are YCbCr.
  out.segment(0xe0, 14);
  out.write({'J', 'F', 'I', 'F', 0, 1, 1, 0, 0, 1, 0, 1, 0, 0});
  const std::uint32_t percent = jpeg_percent(quality);
  const auto places = zigzag();
  for (std::uint32_t channel = 0; channel < 2; ++channel) {
    out.segment(0xdb, 65);
    out.write({channel});
    for (const std::uint8_t place : places) {
      const std::uint32_t base = base_quantisation[64 * channel + place];
      out.write({std::clamp((base * percent + 50) / 100, 1u, 255u)});
    }
  }
  // Three channels of 8 bits: luma with twice the samples in both directions.
  out.segment(0xc0, 15);
  out.write({8});
  out.number(height);
  out.number(width);
  out.write({3, 1, 0x22, 0, 2, 0x11, 1, 3, 0x11, 1});
  for (const HuffmanTable* table : {&luma_dc, &luma_ac, &chroma_dc, &chroma_ac}) {
    out.segment(0xc4, 17 + table->symbols.size());
    out.write({table->id});
    out.write(table->lengths);
    out.write(table->symbols);
  }
  out.segment(0xdd, 2);
  out.number(shared::jpeg_interval_mcus);
  // All frequencies of the three channels in one scan.
  out.segment(0xda, 10);
  out.write({3, 1, 0x00, 2, 0x11, 3, 0x11, 0, 63, 0});
  return bytes;
}

}  // namespace heliograph::render
