#include "scene/image/exr_header.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

struct FixedType {
  std::string_view name;
  std::uint32_t bytes;
};

/// "OpenEXR File Layout": the attribute types of fixed size.
constexpr std::array<FixedType, 24> fixed_types{{{"box2i", 16},
                                                 {"box2f", 16},
                                                 {"chromaticities", 32},
                                                 {"compression", 1},
                                                 {"deepImageState", 1},
                                                 {"double", 8},
                                                 {"envmap", 1},
                                                 {"float", 4},
                                                 {"int", 4},
                                                 {"keycode", 28},
                                                 {"lineOrder", 1},
                                                 {"m33d", 72},
                                                 {"m33f", 36},
                                                 {"m44d", 128},
                                                 {"m44f", 64},
                                                 {"rational", 8},
                                                 {"tiledesc", 9},
                                                 {"timecode", 8},
                                                 {"v2d", 16},
                                                 {"v2f", 8},
                                                 {"v2i", 8},
                                                 {"v3d", 24},
                                                 {"v3f", 12},
                                                 {"v3i", 12}}};

[[noreturn]] void refuse() {
  throw ImportError("has a damaged header");
}

class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : left_(bytes) {}

  bool empty() const { return left_.empty(); }
  bool at_zero() const { return !left_.empty() && left_.front() == 0; }

  std::span<const std::uint8_t> take(std::uint64_t count) {
    if (count > left_.size()) refuse();
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

  std::uint32_t take_u32() {
    std::uint32_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  std::string_view take_text() {
    const auto end = std::find(left_.begin(), left_.end(), std::uint8_t{0});
    const auto length = static_cast<std::size_t>(end - left_.begin());
    const auto text = take(length + 1);
    return {reinterpret_cast<const char*>(text.data()), length};
  }

 private:
  std::span<const std::uint8_t> left_;
};

void check_channels(Bytes value) {
  while (!value.take_text().empty()) value.take(16);
  if (!value.empty()) refuse();
}

void check_texts(Bytes value) {
  while (!value.empty()) value.take(value.take_u32());
}

void check_preview(Bytes value) {
  constexpr std::uint64_t widest = 65536;
  const std::uint64_t width = value.take_u32();
  const std::uint64_t height = value.take_u32();
  if (width > widest || height > widest) refuse();
  value.take(width * height * 4);
  if (!value.empty()) refuse();
}

void check_value(std::string_view type, std::span<const std::uint8_t> value) {
  if (type == "chlist") return check_channels(Bytes(value));
  if (type == "stringvector") return check_texts(Bytes(value));
  if (type == "preview") return check_preview(Bytes(value));
  if (type == "idmanifest") throw ImportError("has an ID manifest, which is not supported");
  const auto fixed = std::find_if(fixed_types.begin(), fixed_types.end(),
                                  [&](const FixedType& known) { return known.name == type; });
  if (fixed != fixed_types.end() && fixed->bytes != value.size()) refuse();
}

}  // namespace

void check_exr_attributes(std::span<const std::uint8_t> file) {
  constexpr std::uint32_t several_parts = 0x1000;
  Bytes bytes(file);
  bytes.take(4);
  const bool several = bytes.take_u32() & several_parts;
  do {
    while (!bytes.take_text().empty()) {
      const std::string_view type = bytes.take_text();
      check_value(type, bytes.take(bytes.take_u32()));
    }
  } while (several && !bytes.empty() && !bytes.at_zero());
}

}  // namespace heliograph::scene
