#include "scene/image/bc7/block_encoder.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "scene/image/bc7/line_fit.hpp"

namespace heliograph::scene::bc7 {
namespace {

/// Up to such an error, a step of 255 in each channel of each texel, no more modes are tried.
constexpr float good_enough = 64.0f;
constexpr int refinements = 2;

/// From the lowest bit of the first byte on.
class BitWriter {
 public:
  /// @param value has no more bits than `count`
  void write(std::uint64_t value, int count) {
    words_[position_ / 64] |= value << (position_ % 64);
    // No shift by 64: what lies across the words is written to both.
    if (position_ % 64 + count > 64) words_[1] |= value >> (64 - position_ % 64);
    position_ += count;
  }
  Block bytes() const {
    Block bytes;
    for (int i = 0; i < block_bytes; ++i) {
      bytes[i] = static_cast<std::uint8_t>(words_[i / 8] >> (8 * (i % 8)));
    }
    return bytes;
  }

 private:
  std::array<std::uint64_t, 2> words_{};
  int position_ = 0;
};

struct Texels {
  std::array<Plane, 4> channels;
  Plane all;  // members: every texel
  bool opaque = true;
};

Texels spread(const std::array<std::uint8_t, 64>& texels) {
  Texels spread;
  for (int i = 0; i < texels_of_block; ++i) {
    for (int c = 0; c < 4; ++c) spread.channels[c].of[i] = texels[4 * i + c];
    spread.opaque &= texels[4 * i + 3] == 255;
  }
  spread.all.of.fill(1.0f);
  return spread;
}

Cluster whole(const Texels& texels) {
  const auto& [red, green, blue, alpha] = texels.channels;
  return {{&red, &green, &blue, &alpha}, &texels.all, texels.opaque};
}

/// How to encode a block, and with which error.
struct Choice {
  int mode = 6;
  std::size_t variant = 0;      // partition; mode 5: the channel that is apart
  std::array<LineFit, 2> fits;  // of both subsets; mode 5: of three channels and of one
  float error = 0.0f;
};

/// The highest bit of the anchor's index is not stored: the ends change places where it is set.
void anchor(LineFit& fit, int texel, int index_bits) {
  const int last = (1 << index_bits) - 1;
  if (2 * static_cast<int>(fit.indices.of[texel]) <= last) return;
  std::swap(fit.codes[0], fit.codes[1]);
  std::swap(fit.low_bits[0], fit.low_bits[1]);
  for (float& index : fit.indices.of) index = static_cast<float>(last) - index;
}

void write_indices(BitWriter& writer, const Plane& indices, int index_bits, int second_anchor) {
  std::uint64_t bits = 0;
  int position = 0;
  for (int i = 0; i < texels_of_block; ++i) {
    bits |= static_cast<std::uint64_t>(static_cast<int>(indices.of[i])) << position;
    position += index_bits - (i == 0 || i == second_anchor ? 1 : 0);
  }
  writer.write(bits, position);
}

void write_ends(BitWriter& writer, const LineFit& fit, int channel, int bits) {
  for (const auto& end : fit.codes) writer.write(end[channel], bits);
}

Block write_mode_6(LineFit fit) {
  anchor(fit, 0, mode_6.index_bits);
  BitWriter writer;
  writer.write(1u << 6, 7);
  for (int c = 0; c < 4; ++c) write_ends(writer, fit, c, mode_6.bits - 1);
  for (const std::uint8_t bit : fit.low_bits) writer.write(bit, 1);
  write_indices(writer, fit.indices, mode_6.index_bits, 0);
  return writer.bytes();
}

Block write_mode_5(LineFit colors, LineFit scalar, std::size_t scalar_channel) {
  anchor(colors, 0, mode_5.index_bits);
  anchor(scalar, 0, mode_5_scalar.index_bits);
  BitWriter writer;
  writer.write(1u << 5, 6);
  writer.write((scalar_channel + 1) % 4, 2);  // the rotation: 0 none, 1 red and alpha, ...
  for (int c = 0; c < 3; ++c) write_ends(writer, colors, c, mode_5.bits);
  write_ends(writer, scalar, 0, mode_5_scalar.bits);
  write_indices(writer, colors.indices, mode_5.index_bits, 0);
  write_indices(writer, scalar.indices, mode_5_scalar.index_bits, 0);
  return writer.bytes();
}

const LineFormat& format_of(int mode) {
  if (mode == 1) return mode_1;
  return mode == 3 ? mode_3 : mode_7;
}

Block write_two_subsets(int mode, std::size_t partition, std::array<LineFit, 2> fits) {
  const LineFormat& format = format_of(mode);
  const int second_anchor = second_anchors[partition];
  anchor(fits[0], 0, format.index_bits);
  anchor(fits[1], second_anchor, format.index_bits);
  BitWriter writer;
  writer.write(1u << mode, mode + 1);
  writer.write(static_cast<std::uint32_t>(partition), 6);
  for (int c = 0; c < format.channels; ++c) {
    for (const LineFit& fit : fits) write_ends(writer, fit, c, format.bits - 1);
  }
  const int stored_low_bits = format.low_bit == LineFormat::LowBit::shared ? 1 : 2;
  for (const LineFit& fit : fits) {
    for (int i = 0; i < stored_low_bits; ++i) writer.write(fit.low_bits[i], 1);
  }
  Plane indices = fits[0].indices;
  for (int i = 0; i < texels_of_block; ++i) {
    if (second_subsets[partition] >> i & 1) indices.of[i] = fits[1].indices.of[i];
  }
  write_indices(writer, indices, format.index_bits, second_anchor);
  return writer.bytes();
}

Block write(const Choice& choice) {
  if (choice.mode == 6) return write_mode_6(choice.fits[0]);
  if (choice.mode == 5) return write_mode_5(choice.fits[0], choice.fits[1], choice.variant);
  return write_two_subsets(choice.mode, choice.variant, choice.fits);
}

/// Codes of a channel between which, at the weight of index 1, its value lies exactly.
struct ExactEnds {
  std::uint8_t first;
  std::uint8_t second;
};

std::array<ExactEnds, 256> find_exact_ends() {
  constexpr int weight = weight_of(1, mode_5.index_bits);
  std::array<ExactEnds, 256> ends{};
  for (int first = 0; first < 128; ++first) {
    for (int second = first; second < std::min(first + 3, 128); ++second) {
      const int value = ((64 - weight) * expanded(first, mode_5.bits) +
                         weight * expanded(second, mode_5.bits) + 32) >>
                        6;
      ends[value] = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second)};
    }
  }
  return ends;
}

Block write_solid(const std::array<std::uint8_t, 4>& color) {
  static const std::array<ExactEnds, 256> exact = find_exact_ends();
  LineFit colors, scalar;
  for (int c = 0; c < 3; ++c) {
    colors.codes[0][c] = exact[color[c]].first;
    colors.codes[1][c] = exact[color[c]].second;
  }
  colors.indices.of.fill(1.0f);
  scalar.codes[0][0] = scalar.codes[1][0] = color[3];
  return write_mode_5(colors, scalar, 3);
}

bool is_solid(const std::array<std::uint8_t, 64>& texels) {
  return std::equal(texels.begin() + 4, texels.end(), texels.begin());
}

void try_mode_5(const Texels& texels, std::size_t scalar_channel, Choice& best) {
  Cluster colors = whole(texels);
  Cluster scalar = colors;
  std::swap(colors.channels[scalar_channel], colors.channels[3]);
  scalar.channels[0] = colors.channels[3];
  const PrincipalAxis axis = principal_axis(colors, 3);
  if (axis.distance() >= best.error) return;
  Choice choice{5, scalar_channel, {}, 0.0f};
  choice.fits[0] = fit_line(colors, axis, mode_5, refinements);
  choice.fits[1] = fit_line(scalar, principal_axis(scalar, 1), mode_5_scalar, refinements);
  choice.error = choice.fits[0].error + choice.fits[1].error;
  if (choice.error < best.error) best = choice;
}

using Color = std::array<float, 4>;

/// Sums of the colours of every set of texels of a row, by the bits of the set.
using RowSums = std::array<std::array<Color, 16>, 4>;

RowSums sum_rows(const Texels& texels, const PrincipalAxis& axis) {
  RowSums sums{};
  for (int row = 0; row < 4; ++row) {
    for (unsigned set = 1; set < 16; ++set) {
      const int texel = 4 * row + std::countr_zero(set);
      const Color& others = sums[row][set & (set - 1)];
      for (int c = 0; c < 4; ++c) {
        sums[row][set][c] = others[c] + texels.channels[c].of[texel] - axis.mean[c];
      }
    }
  }
  return sums;
}

/// 1 / n + 1 / m for subsets of n and m texels.
std::array<float, 64> find_shares() {
  std::array<float, 64> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto count = static_cast<float>(std::popcount(second_subsets[i]));
    shares[i] = 1.0f / count + 1.0f / (texels_of_block - count);
  }
  return shares;
}

/// The partition whose subsets have the most different means: what is left has the least variance.
std::size_t likely_partition(const Texels& texels, const PrincipalAxis& axis) {
  static const std::array<float, 64> shares = find_shares();
  const RowSums rows = sum_rows(texels, axis);
  std::size_t best = 0;
  float best_score = 0.0f;
  for (std::size_t partition = 0; partition < second_subsets.size(); ++partition) {
    const unsigned set = second_subsets[partition];
    const Color &a = rows[0][set & 15], &b = rows[1][set >> 4 & 15], &c = rows[2][set >> 8 & 15],
                &d = rows[3][set >> 12];
    // The sums of both subsets are opposite: colours are from the mean of all.
    Color sum;
    for (int i = 0; i < 4; ++i) sum[i] = (a[i] + b[i]) + (c[i] + d[i]);
    const float squares = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2] + sum[3] * sum[3];
    const float score = squares * shares[partition];
    if (score <= best_score) continue;
    best_score = score;
    best = partition;
  }
  return best;
}

Plane members_of(unsigned set) {
  Plane members;
  for (int i = 0; i < texels_of_block; ++i) members.of[i] = static_cast<float>(set >> i & 1u);
  return members;
}

/// Where subsets are so short, two index bits and finer ends fit better than three and coarser.
constexpr float short_line = 12.0f;

void try_two_subsets(const Texels& texels, std::size_t partition, Choice& best) {
  const unsigned second = second_subsets[partition];
  const std::array<Plane, 2> members{members_of(~second), members_of(second)};
  std::array<Cluster, 2> clusters;
  std::array<PrincipalAxis, 2> axes;
  for (int subset = 0; subset < 2; ++subset) {
    clusters[subset] = whole(texels);
    clusters[subset].members = &members[subset];
    axes[subset] = principal_axis(clusters[subset], texels.opaque ? 3 : 4);
  }
  if (axes[0].distance() + axes[1].distance() >= best.error) return;
  const float longest = std::max(axes[0].last - axes[0].first, axes[1].last - axes[1].first);
  const int opaque_mode = longest < short_line ? 3 : 1;
  Choice choice{texels.opaque ? opaque_mode : 7, partition, {}, 0.0f};
  for (int subset = 0; subset < 2; ++subset) {
    choice.fits[subset] =
        fit_line(clusters[subset], axes[subset], format_of(choice.mode), refinements);
    choice.error += choice.fits[subset].error;
    if (choice.error >= best.error) return;
  }
  best = choice;
}

/// The channel that is farthest from the line of all.
std::size_t loneliest_channel(const PrincipalAxis& axis) {
  return static_cast<std::size_t>(std::ranges::max_element(axis.residual) - axis.residual.begin());
}

}  // namespace

EncodedBlock encode_block(const std::array<std::uint8_t, 64>& block) {
  if (is_solid(block)) return {write_solid({block[0], block[1], block[2], block[3]}), 0.0f};
  const Texels texels = spread(block);
  const PrincipalAxis axis = principal_axis(whole(texels), 4);
  Choice best;
  best.fits[0] = fit_line(whole(texels), axis, mode_6, refinements);
  best.error = best.fits[0].error;
  if (best.error > good_enough) try_mode_5(texels, loneliest_channel(axis), best);
  if (best.error > good_enough) try_two_subsets(texels, likely_partition(texels, axis), best);
  return {write(best), best.error};
}

}  // namespace heliograph::scene::bc7
