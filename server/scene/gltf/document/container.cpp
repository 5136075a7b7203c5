#include "scene/gltf/document/container.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

constexpr std::uint32_t glb_magic = 0x46546c67;         // "glTF"
constexpr std::uint32_t glb_json_chunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t glb_binary_chunk = 0x004e4942;  // "BIN"

}  // namespace

Container::Container(RegularFile file) : file_(std::move(file)) {
  if (file_.size() == 0) throw ImportError("the file is empty");
  if (file_.size() >= 4 && read_word(0) == glb_magic) {
    read_chunks();
    return;
  }
  text_ = read_text(0, file_.size());
  const std::size_t start = text_.find_first_not_of(" \t\r\n");
  if (start == std::string::npos || text_[start] != '{') {
    throw ImportError("not a glTF file: neither GLB nor JSON");
  }
}

void Container::read_chunks() {
  if (file_.size() < 12) throw ImportError("GLB header is truncated");
  const std::uint32_t version = read_word(4);
  if (version != 2) throw ImportError("GLB version " + std::to_string(version) + " is not 2");
  const std::uint32_t length = read_word(8);
  if (length > file_.size() || length < 12) {
    throw ImportError("GLB is truncated: its header claims more bytes");
  }
  std::uint64_t offset = 12;
  for (int chunk = 0; offset < length && chunk < 2; ++chunk) {
    if (length - offset < 8) throw ImportError("GLB chunk header is truncated");
    const std::uint64_t size = read_word(offset);
    const std::uint32_t type = read_word(offset + 4);
    offset += 8;
    if (size > length - offset) throw ImportError("GLB chunk reaches past the end of the file");
    if (chunk == 0 && type == glb_json_chunk) text_ = read_text(offset, size);
    if (chunk == 0 && type != glb_json_chunk) break;
    if (chunk == 1 && type == glb_binary_chunk) {
      binary_offset_ = offset;
      binary_bytes_ = size;
    }
    offset += std::min<std::uint64_t>((size + 3) / 4 * 4, length - offset);
  }
  if (text_.empty()) throw ImportError("GLB does not begin with a JSON chunk");
}

void Container::read_binary(std::uint64_t offset, std::span<std::uint8_t> bytes,
                            const std::stop_token& stop) const {
  file_.read(binary_offset_ + offset, bytes, stop);
}

std::string Container::read_text(std::uint64_t offset, std::uint64_t bytes) const {
  std::string text(bytes, '\0');
  file_.read(offset, {reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  return text;
}

// glTF is little-endian, as is every machine this server runs on.
std::uint32_t Container::read_word(std::uint64_t offset) const {
  std::array<std::uint8_t, 4> bytes{};
  file_.read(offset, bytes);
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

}  // namespace heliograph::scene
