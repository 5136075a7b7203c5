#include "tests/unit/scene/support/ktx2_files.hpp"

#include <zstd.h>

#include "scene/gltf/document/uri.hpp"

namespace heliograph::scene::test {
namespace {

constexpr std::string_view etc1s_file =
    "q0tUWCAyMLsNChoKAAAAAAEAAAAOAAAACgAAAAAAAAAAAAAAAQAAAAQAAAABAAAAsAAAADwAAADsAAAAJAAAABAB"
    "AAAAAAAAKwEAAAAAAABKAgAAAAAAAA4AAAAAAAAAAAAAAAAAAABDAgAAAAAAAAcAAAAAAAAAAAAAAAAAAAA/AgAA"
    "AAAAAAQAAAAAAAAAAAAAAAAAAAA7AgAAAAAAAAQAAAAAAAAAAAAAAAAAAAA8AAAAAAAAAAIAOACjAQIAAwMAAAgI"
    "AAAAAAAAAAA/AAAAAAAAAAAA/////0AAPw8AAAAAAAAAAP////8fAAAAS1RYd3JpdGVyAEJhc2lzIFVuaXZlcnNh"
    "bCAyLjUwAAAZAAwAYAAAACwAAAA7AAAAAAAAAAAAAAAAAAAABQAAAAUAAAAJAAAAAAAAAAAAAAAEAAAABAAAAAMA"
    "AAAAAAAAAAAAAAIAAAACAAAAAgAAAAAAAAAAAAAAAgAAAAIAAAACAAAAGEAcAAEAACDYPilePIBHAAMABALvQZex"
    "HtamQgcQB0AAAEEg+EQNtSYq5yMAEwAGAAACAdgzZLYvpilJSDdnFCIQ9W+M1FRBVDn7gNpeP03x181SRfqyArnv"
    "U8pkza1JAAjiBAzAQAwDL1JABJLHLibpscjM4AGqVP8NOIaZ+Xb3vztJIoljeDhA2wIAwUSAAQAAQACWU/5ObQE8"
    "A5gDIQAAEAAA3a4M8jQBbxsGABiEKZ+QIwpKRrA3wQCYAQAAAAAAQAoQAG4CXgGmA3YDqoDhAG0BJSIB0FSATUHC"
    "2X/3FhcO";

template <typename T>
void append(Bytes& file, std::initializer_list<T> values) {
  for (const T value : values) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(&value);
    file.insert(file.end(), first, first + sizeof value);
  }
}

}  // namespace

Bytes ktx2_of_blocks(std::uint32_t width, std::uint32_t height, const Bytes& blocks,
                     bool zstandard) {
  Bytes data = blocks;
  if (zstandard) {
    data.resize(ZSTD_compressBound(blocks.size()));
    data.resize(ZSTD_compress(data.data(), data.size(), blocks.data(), blocks.size(), 3));
  }
  constexpr std::uint32_t header_bytes = 104;  // with one level
  constexpr std::uint32_t format_bytes = 44;
  Bytes file = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
  append<std::uint32_t>(file, {0, 1, width, height, 0, 0, 1, 1, zstandard ? 2u : 0u});
  append<std::uint32_t>(file, {header_bytes, format_bytes, 0, 0});
  append<std::uint64_t>(file, {0, 0, header_bytes + format_bytes, data.size(), blocks.size()});
  append<std::uint32_t>(file, {format_bytes, 0, 2u | (format_bytes - 4) << 16});
  // UASTC, BT.709 primaries, linear; blocks of 4 x 4 in 16 bytes; one sample, RGBA.
  append<std::uint8_t>(file, {166, 1, 1, 0, 3, 3, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0});
  append<std::uint8_t>(file, {0, 0, 127, 3, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255});
  file.insert(file.end(), data.begin(), data.end());
  return file;
}

Bytes ktx2_of_etc1s() {
  return *decode_data_uri("data:;base64," + std::string(etc1s_file));
}

std::array<int, 4> etc1s_texel(int x, int y) {
  return {16 * x, 24 * y, 255 - 16 * x, 255 - 12 * y};
}

}  // namespace heliograph::scene::test
