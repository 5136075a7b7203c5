#include "scene/image/bc7/line_fit.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace heliograph::scene::bc7 {
namespace {

// Loops over texels have a fixed length and no branches, which compilers turn into vectors.

using Ends = std::array<std::array<float, 4>, 2>;

/// Four sums side by side: the order of the additions is that of a vector.
template <typename Term>
float sum_of(const Term& term) {
  std::array<float, 4> sums{};
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 4; ++i) sums[i] += term(4 * row + i);
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

std::pair<float, float> range_of(const Plane& plane) {
  std::array<float, 4> least{}, most{};
  for (int i = 0; i < 4; ++i) least[i] = most[i] = plane.of[i];
  for (int row = 1; row < 4; ++row) {
    for (int i = 0; i < 4; ++i) {
      least[i] = std::min(least[i], plane.of[4 * row + i]);
      most[i] = std::max(most[i], plane.of[4 * row + i]);
    }
  }
  return {std::ranges::min(least), std::ranges::max(most)};
}

Ends ends_of(const PrincipalAxis& axis, int channels) {
  Ends ends{};
  for (int c = 0; c < channels; ++c) {
    ends[0][c] = std::clamp(axis.mean[c] + axis.first * axis.direction[c], 0.0f, 255.0f);
    ends[1][c] = std::clamp(axis.mean[c] + axis.last * axis.direction[c], 0.0f, 255.0f);
  }
  return ends;
}

/// How channels of a format are stored with a low bit, or without any.
struct CodeScale {
  int bits;
  int low_bit;         // of the stored value
  int step;            // of the stored value, between codes
  int most;            // the largest code
  float steps_of_255;  // 1 / 255 of the stored values

  CodeScale(const LineFormat& format, int low)
      : bits(format.bits),
        low_bit(low),
        step(format.low_bit == LineFormat::LowBit::none ? 1 : 2),
        most((1 << bits) / step - 1),
        steps_of_255(static_cast<float>((1 << bits) - 1) / 255.0f) {}

  int nearest(float value) const {
    const float stored = value * steps_of_255 - static_cast<float>(low_bit);
    const float code = stored * (step == 2 ? 0.5f : 1.0f) + 0.5f;
    return std::clamp(static_cast<int>(code), 0, most);
  }
  float value(int code) const { return static_cast<float>(expanded(step * code + low_bit, bits)); }
};

/// The nearest values that can be stored. @return the sum of squared differences
float store_end(const std::array<float, 4>& end, int channels, const CodeScale& scale,
                std::array<std::uint8_t, 4>& codes) {
  float error = 0.0f;
  for (int c = 0; c < channels; ++c) {
    const int code = scale.nearest(end[c]);
    codes[c] = static_cast<std::uint8_t>(code);
    const float difference = scale.value(code) - end[c];
    error += difference * difference;
  }
  return error;
}

/// Both low bits are tried. What is opaque stays so: alpha is 255 with the bit set alone.
void store_ends(const Ends& ends, const LineFormat& format, bool opaque, LineFit& fit) {
  using LowBit = LineFormat::LowBit;
  if (format.low_bit == LowBit::none) {
    const CodeScale scale(format, 0);
    for (int end = 0; end < 2; ++end) {
      store_end(ends[end], format.channels, scale, fit.codes[end]);
    }
    return;
  }
  std::array<std::array<std::array<std::uint8_t, 4>, 2>, 2> codes{};  // by low bit, by end
  std::array<std::array<float, 2>, 2> errors{};
  for (int bit = opaque ? 1 : 0; bit < 2; ++bit) {
    const CodeScale scale(format, bit);
    for (int end = 0; end < 2; ++end) {
      errors[bit][end] = store_end(ends[end], format.channels, scale, codes[bit][end]);
    }
  }
  for (int end = 0; end < 2; ++end) {
    const bool set = format.low_bit == LowBit::shared
                         ? errors[1][0] + errors[1][1] < errors[0][0] + errors[0][1]
                         : errors[1][end] < errors[0][end];
    fit.low_bits[end] = opaque || set ? 1 : 0;
    fit.codes[end] = codes[fit.low_bits[end]][end];
  }
}

Ends stored_ends(const LineFit& fit, const LineFormat& format) {
  Ends ends{};
  for (int end = 0; end < 2; ++end) {
    const CodeScale scale(format, fit.low_bits[end]);
    for (int c = 0; c < format.channels; ++c) ends[end][c] = scale.value(fit.codes[end][c]);
  }
  return ends;
}

/// The index of the nearest colour on the line for each texel, and the weights of these colours.
void choose_indices(const Cluster& cluster, const LineFormat& format, const Ends& ends,
                    Plane& indices, Plane& weights) {
  const float last = static_cast<float>((1 << format.index_bits) - 1);
  float length = 0.0f, offset = 0.0f;
  std::array<float, 4> step{};
  for (int c = 0; c < format.channels; ++c) {
    step[c] = ends[1][c] - ends[0][c];
    length += step[c] * step[c];
    offset += step[c] * ends[0][c];
  }
  const float scale = length > 0.0f ? last / length : 0.0f;
  Plane along;
  for (int c = 0; c < format.channels; ++c) {
    const Plane& channel = *cluster.channels[c];
    const float factor = step[c] * scale;
    for (int i = 0; i < texels_of_block; ++i) along.of[i] += factor * channel.of[i];
  }
  const float half_up = 0.5f - offset * scale;
  const float weight_step = 64.0f / last;
  for (int i = 0; i < texels_of_block; ++i) {
    const float limited = std::min(std::max(along.of[i] + half_up, 0.0f), last + 0.5f);
    const float index = static_cast<float>(static_cast<int>(limited));
    indices.of[i] = index;
    weights.of[i] = static_cast<float>(static_cast<int>(index * weight_step + 0.5f));
  }
}

/// As a decoder rounds it.
float error_of(const Cluster& cluster, int channels, const Ends& ends, const Plane& weights) {
  float error = 0.0f;
  for (int c = 0; c < channels; ++c) {
    const Plane& channel = *cluster.channels[c];
    const float first = ends[0][c] + 0.5f;
    const float step = (ends[1][c] - ends[0][c]) / 64.0f;
    error += sum_of([&](int i) {
      const float value = static_cast<float>(static_cast<int>(first + step * weights.of[i]));
      const float difference = value - channel.of[i];
      return difference * difference * cluster.members->of[i];
    });
  }
  return error;
}

/// The ends for which these weights give the least error; false where many do.
bool least_squares(const Cluster& cluster, int channels, const Plane& weights, Ends& ends) {
  Plane near, far;  // shares of the two ends
  for (int i = 0; i < texels_of_block; ++i) {
    far.of[i] = weights.of[i] / 64.0f * cluster.members->of[i];
    near.of[i] = cluster.members->of[i] - far.of[i];
  }
  const float near_near = sum_of([&](int i) { return near.of[i] * near.of[i]; });
  const float near_far = sum_of([&](int i) { return near.of[i] * far.of[i]; });
  const float far_far = sum_of([&](int i) { return far.of[i] * far.of[i]; });
  const float determinant = near_near * far_far - near_far * near_far;
  constexpr float least_determinant = 0.01f;  // of two texels with different weights: 0.02
  if (determinant < least_determinant) return false;
  for (int c = 0; c < channels; ++c) {
    const Plane& channel = *cluster.channels[c];
    const float at_near = sum_of([&](int i) { return near.of[i] * channel.of[i]; });
    const float at_far = sum_of([&](int i) { return far.of[i] * channel.of[i]; });
    ends[0][c] = std::clamp((far_far * at_near - near_far * at_far) / determinant, 0.0f, 255.0f);
    ends[1][c] = std::clamp((near_near * at_far - near_far * at_near) / determinant, 0.0f, 255.0f);
  }
  return true;
}

LineFit stored_fit(const Cluster& cluster, const LineFormat& format, const Ends& ends,
                   Plane& weights) {
  LineFit fit;
  store_ends(ends, format, cluster.opaque && format.channels == 4, fit);
  const Ends stored = stored_ends(fit, format);
  choose_indices(cluster, format, stored, fit.indices, weights);
  fit.error = error_of(cluster, format.channels, stored, weights);
  return fit;
}

using Covariance = std::array<std::array<float, 4>, 4>;

/// By the power method, from the row of the channel that varies most.
std::array<float, 4> greatest_eigenvector(const Covariance& covariance, int channels) {
  int widest = 0;
  for (int c = 1; c < channels; ++c) {
    if (covariance[c][c] > covariance[widest][widest]) widest = c;
  }
  std::array<float, 4> vector = covariance[widest];
  constexpr int iterations = 4;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    std::array<float, 4> next{};
    float largest = 0.0f;
    for (int c = 0; c < channels; ++c) {
      for (int i = 0; i < channels; ++i) next[c] += covariance[c][i] * vector[i];
      largest = std::max(largest, std::abs(next[c]));
    }
    if (largest <= 0.0f) return {};
    for (int c = 0; c < channels; ++c) vector[c] = next[c] / largest;
  }
  float squares = 0.0f;
  for (int c = 0; c < channels; ++c) squares += vector[c] * vector[c];
  const float scale = 1.0f / std::sqrt(squares);
  for (float& component : vector) component *= scale;
  return vector;
}

}  // namespace

PrincipalAxis principal_axis(const Cluster& cluster, int channels) {
  PrincipalAxis axis;
  std::array<Plane, 4> centred;
  const Plane& members = *cluster.members;
  const float count = sum_of([&](int i) { return members.of[i]; });
  for (int c = 0; c < channels; ++c) {
    const Plane& channel = *cluster.channels[c];
    const float mean = sum_of([&](int i) { return channel.of[i] * members.of[i]; }) / count;
    for (int i = 0; i < texels_of_block; ++i) {
      centred[c].of[i] = (channel.of[i] - mean) * members.of[i];
    }
    axis.mean[c] = mean;
  }
  Covariance covariance{};
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d <= c; ++d) {
      covariance[c][d] = covariance[d][c] =
          sum_of([&](int i) { return centred[c].of[i] * centred[d].of[i]; });
    }
  }
  axis.direction = greatest_eigenvector(covariance, channels);
  Plane along;  // 0, the mean, for texels that are no members
  for (int c = 0; c < channels; ++c) {
    const float factor = axis.direction[c];
    for (int i = 0; i < texels_of_block; ++i) along.of[i] += factor * centred[c].of[i];
  }
  const float spread = sum_of([&](int i) { return along.of[i] * along.of[i]; });
  std::tie(axis.first, axis.last) = range_of(along);
  for (int c = 0; c < channels; ++c) {
    const float explained = axis.direction[c] * axis.direction[c] * spread;
    axis.residual[c] = std::max(covariance[c][c] - explained, 0.0f);
  }
  return axis;
}

LineFit fit_line(const Cluster& cluster, const PrincipalAxis& axis, const LineFormat& format,
                 int refinements) {
  Ends ends = ends_of(axis, format.channels);
  Plane weights;
  LineFit best = stored_fit(cluster, format, ends, weights);
  for (int i = 0; i < refinements && best.error > 0.0f; ++i) {
    if (!least_squares(cluster, format.channels, weights, ends)) break;
    const LineFit refined = stored_fit(cluster, format, ends, weights);
    if (refined.error >= best.error) break;
    best = refined;
  }
  return best;
}

}  // namespace heliograph::scene::bc7
