#include "scene/image/ktx2/uastc.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "scene/image/ktx2/bit_reader.hpp"
#include "scene/image/ktx2/uastc_patterns.hpp"

namespace heliograph::scene::ktx2 {
namespace {

enum class Digits { none, trits, quints };
enum class Colors { rgb, rgba, luminance_alpha };

constexpr std::uint32_t solid_mode = 8;

struct Mode {
  std::uint32_t prefix;  // what the block begins with
  std::uint32_t prefix_bits;
  std::uint32_t endpoint_bits;
  Digits digits;
  std::uint32_t weight_bits;
  std::uint32_t subsets;
  std::uint32_t planes;
  Colors colors;
  std::uint32_t hint_bits;     // for transcoders
  std::uint32_t pattern_bits;  // of the partition
  std::uint32_t plane_bits;    // of the channel with its own weights
};

constexpr std::array<Mode, 19> modes = {{
    {0x01, 4, 6, Digits::trits, 4, 1, 1, Colors::rgb, 15, 0, 0},
    {0x35, 6, 8, Digits::none, 2, 1, 1, Colors::rgb, 15, 0, 0},
    {0x1d, 5, 4, Digits::none, 3, 2, 1, Colors::rgb, 15, 5, 0},
    {0x03, 5, 2, Digits::trits, 2, 3, 1, Colors::rgb, 15, 4, 0},
    {0x13, 5, 3, Digits::quints, 2, 2, 1, Colors::rgb, 15, 5, 0},
    {0x0b, 5, 8, Digits::none, 3, 1, 1, Colors::rgb, 15, 0, 0},
    {0x1b, 5, 5, Digits::quints, 2, 1, 2, Colors::rgb, 15, 0, 2},
    {0x07, 5, 3, Digits::quints, 2, 2, 1, Colors::rgb, 15, 5, 0},
    {0x17, 5, 8, Digits::none, 0, 1, 1, Colors::rgba, 0, 0, 0},
    {0x0f, 5, 4, Digits::none, 2, 2, 1, Colors::rgba, 23, 5, 0},
    {0x02, 3, 4, Digits::trits, 4, 1, 1, Colors::rgba, 17, 0, 0},
    {0x00, 2, 4, Digits::trits, 2, 1, 2, Colors::rgba, 17, 0, 2},
    {0x06, 3, 6, Digits::trits, 3, 1, 1, Colors::rgba, 17, 0, 0},
    {0x1f, 5, 8, Digits::none, 1, 1, 2, Colors::rgba, 23, 0, 2},
    {0x0d, 5, 8, Digits::none, 2, 1, 1, Colors::rgba, 23, 0, 0},
    {0x05, 7, 8, Digits::none, 4, 1, 1, Colors::luminance_alpha, 23, 0, 0},
    {0x15, 6, 8, Digits::none, 2, 2, 1, Colors::luminance_alpha, 23, 5, 0},
    {0x25, 6, 8, Digits::none, 2, 1, 2, Colors::luminance_alpha, 23, 0, 0},
    {0x09, 4, 5, Digits::none, 5, 1, 1, Colors::rgb, 15, 0, 0},
}};

constexpr std::size_t most_values = 18;  // of endpoints

using Texels = std::array<std::uint8_t, 64>;

Texels filled(std::uint8_t red, std::uint8_t green, std::uint8_t blue, std::uint8_t alpha) {
  Texels texels;
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    texels[i] = red;
    texels[i + 1] = green;
    texels[i + 2] = blue;
    texels[i + 3] = alpha;
  }
  return texels;
}

std::optional<std::uint32_t> mode_of(std::uint8_t first_byte) {
  for (std::uint32_t i = 0; i < modes.size(); ++i) {
    if ((first_byte & ((1u << modes[i].prefix_bits) - 1u)) == modes[i].prefix) return i;
  }
  return std::nullopt;
}

std::optional<std::string_view> pattern_of(std::uint32_t mode, std::uint32_t index) {
  const auto find = [&](const auto& patterns) -> std::optional<std::string_view> {
    if (index >= patterns.size()) return std::nullopt;
    return patterns[index];
  };
  if (modes[mode].subsets == 1) return std::string_view("0000000000000000");
  if (modes[mode].subsets == 3) return find(three_subsets);
  return mode == 7 ? find(two_subsets_of_mode_7) : find(two_subsets);
}

/// Trits come five to a byte, quints three to seven bits, the rest in as few bits as they need.
void read_digits(BitReader& bits, Digits kind, std::size_t count,
                 std::array<std::uint32_t, most_values>& digits) {
  if (kind == Digits::none) return;
  constexpr std::array<std::uint32_t, 6> bits_of_trits = {0, 2, 4, 5, 7, 8};
  const std::uint32_t base = kind == Digits::trits ? 3 : 5;
  const std::size_t group = kind == Digits::trits ? 5 : 3;
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t size = std::min(group, count - first);
    std::uint32_t packed = bits.read(kind == Digits::trits ? bits_of_trits[size] : 7);
    for (std::size_t i = 0; i < size; ++i, packed /= base) digits[first + i] = packed % base;
  }
}

/// The bits of `value` from the second on, at places of a pattern such as "cb0000cbc" of ASTC.
std::uint32_t spread(std::uint32_t value, std::string_view pattern) {
  std::uint32_t result = 0;
  for (const char place : pattern) {
    result = result << 1 | (place == '0' ? 0u : value >> (place - 'a') & 1u);
  }
  return result;
}

/// An endpoint as a number of 8 bits (ASTC, "Endpoint Unquantization").
std::uint32_t expand(std::uint32_t bits, std::uint32_t digit, const Mode& mode) {
  if (mode.digits == Digits::none) {
    std::uint32_t value = bits << (8 - mode.endpoint_bits);
    for (std::uint32_t have = mode.endpoint_bits; have < 8; have *= 2) value |= value >> have;
    return value & 0xffu;
  }
  struct Parameters {
    std::string_view pattern;
    std::uint32_t factor;
  };
  const auto [pattern, factor] = [&]() -> Parameters {
    if (mode.digits == Digits::quints) {
      return mode.endpoint_bits == 3 ? Parameters{"cb0000cbc", 26} : Parameters{"edcb0000e", 6};
    }
    if (mode.endpoint_bits == 2) return {"b000b0bb0", 93};
    return mode.endpoint_bits == 4 ? Parameters{"dcb000dcb", 22} : Parameters{"fedcb000f", 5};
  }();
  const std::uint32_t mirror = bits & 1u ? 0x1ffu : 0u;
  const std::uint32_t value = (digit * factor + spread(bits, pattern)) ^ mirror;
  return (mirror & 0x80u) | value >> 2;
}

std::uint32_t expand_weight(std::uint32_t weight, std::uint32_t bits) {
  std::uint32_t value = 0;
  for (int have = 0; have < 6; have += static_cast<int>(bits)) {
    const int shift = 6 - have - static_cast<int>(bits);
    value |= shift >= 0 ? weight << shift : weight >> -shift;
  }
  return value > 32 ? value + 1 : value;
}

using Color = std::array<std::uint32_t, 4>;
struct Endpoints {
  Color low;
  Color high;
};

/// Reads the endpoints of all subsets.
std::array<Endpoints, 3> read_endpoints(BitReader& bits, const Mode& mode) {
  const std::size_t channels = mode.colors == Colors::rgb ? 3 : mode.colors == Colors::rgba ? 4 : 2;
  const std::size_t count = 2 * channels * mode.subsets;
  std::array<std::uint32_t, most_values> digits{};
  read_digits(bits, mode.digits, count, digits);
  std::array<std::uint32_t, most_values> values{};
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = expand(bits.read(mode.endpoint_bits), digits[i], mode);
  }
  std::array<Endpoints, 3> result{};
  for (std::size_t subset = 0; subset < mode.subsets; ++subset) {
    const std::uint32_t* const own = values.data() + 2 * channels * subset;
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const bool gray = mode.colors == Colors::luminance_alpha;
      const std::size_t source = gray ? channel / 3 : channel;
      const bool opaque = source >= channels;
      result[subset].low[channel] = opaque ? 255 : own[2 * source];
      result[subset].high[channel] = opaque ? 255 : own[2 * source + 1];
    }
  }
  return result;
}

Texels interpolate(BitReader& bits, std::uint32_t mode_index, bool srgb) {
  const Mode& mode = modes[mode_index];
  bits.read(mode.hint_bits > 16 ? 16 : mode.hint_bits);
  bits.read(mode.hint_bits > 16 ? mode.hint_bits - 16 : 0);
  const auto pattern = pattern_of(mode_index, bits.read(mode.pattern_bits));
  if (!pattern) return filled(255, 0, 255, 255);
  // Of modes with luminance the second plane is always alpha.
  const std::uint32_t own_channel = mode.plane_bits > 0 ? bits.read(mode.plane_bits) : 3;
  const std::array<Endpoints, 3> endpoints = read_endpoints(bits, mode);
  Texels texels;
  for (std::size_t i = 0; i < 16; ++i) {
    const char subset = (*pattern)[i];
    // The first weight of a subset has no highest bit.
    const bool anchor = pattern->find(subset) == i;
    std::array<std::uint32_t, 2> weights{};
    for (std::uint32_t plane = 0; plane < mode.planes; ++plane) {
      weights[plane] =
          expand_weight(bits.read(mode.weight_bits - (anchor ? 1 : 0)), mode.weight_bits);
    }
    const auto& [low, high] = endpoints[static_cast<std::size_t>(subset - '0')];
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const std::uint32_t weight = weights[mode.planes == 2 && channel == own_channel ? 1 : 0];
      const std::uint32_t from = low[channel] << 8 | (srgb ? 0x80u : low[channel]);
      const std::uint32_t to = high[channel] << 8 | (srgb ? 0x80u : high[channel]);
      texels[4 * i + channel] =
          static_cast<std::uint8_t>(((from * (64 - weight) + to * weight + 32) >> 6) >> 8);
    }
  }
  return texels;
}

}  // namespace

Texels decode_uastc(std::span<const std::uint8_t, uastc_block_bytes> block, bool srgb) {
  const auto mode = mode_of(block[0]);
  if (!mode) return filled(255, 0, 255, 255);
  BitReader bits(block);
  bits.read(modes[*mode].prefix_bits);
  if (*mode != solid_mode) return interpolate(bits, *mode, srgb);
  std::array<std::uint8_t, 4> color{};
  for (std::uint8_t& channel : color) channel = static_cast<std::uint8_t>(bits.read(8));
  return filled(color[0], color[1], color[2], color[3]);
}

}  // namespace heliograph::scene::ktx2
