// LDR-FLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference
// Evaluator for Alternating Images", 2020. The numbers are those of the paper.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "cli/compare/image_difference.hpp"

namespace heliograph::cli {
namespace {

constexpr double pixels_per_degree = 67.0206;
constexpr double color_exponent = 0.7;
constexpr double color_split = 0.4;
constexpr double color_share = 0.95;
constexpr double feature_exponent = 0.5;
constexpr double feature_width = 0.082;  // degrees

using FlipColor = std::array<double, 3>;
using FlipPlane = std::vector<float>;
using Kernel = std::vector<double>;  // from -radius to radius

// IEC 61966-2-1, D65.
constexpr std::array<FlipColor, 3> rgb_to_xyz{{{0.4124564, 0.3575761, 0.1804375},
                                               {0.2126729, 0.7151522, 0.0721750},
                                               {0.0193339, 0.1191920, 0.9503041}}};
constexpr std::array<FlipColor, 3> xyz_to_rgb{{{3.2404542, -1.5371385, -0.4985314},
                                               {-0.9692660, 1.8760108, 0.0415560},
                                               {0.0556434, -0.2040259, 1.0572252}}};
constexpr FlipColor white{0.9504700, 1.0000001, 1.0888300};  // the XYZ of RGB 1, 1, 1

FlipColor times(const std::array<FlipColor, 3>& matrix, const FlipColor& v) {
  FlipColor result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
  }
  return result;
}

double linear_channel(std::uint8_t value) {
  const double encoded = value / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

FlipColor opponent(const FlipColor& rgb) {
  const FlipColor xyz = times(rgb_to_xyz, rgb);
  const double x = xyz[0] / white[0], y = xyz[1] / white[1], z = xyz[2] / white[2];
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

FlipColor rgb_of_opponent(const FlipColor& c) {
  const double y = (c[0] + 16.0) / 116.0;
  return times(xyz_to_rgb,
               {white[0] * (y + c[1] / 500.0), white[1] * y, white[2] * (y - c[2] / 200.0)});
}

/// CIELAB, with chroma reduced where it is dark (Hunt effect).
FlipColor hunt_lab(const FlipColor& rgb) {
  const FlipColor xyz = times(rgb_to_xyz, rgb);
  constexpr double delta = 6.0 / 29.0;
  FlipColor f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = xyz[i] / white[i];
    f[i] = t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
  }
  const double lightness = 116.0 * f[1] - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (f[0] - f[1]),
          0.01 * lightness * 200.0 * (f[1] - f[2])};
}

double hyab(const FlipColor& a, const FlipColor& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

struct FlipImage {
  std::size_t width, height;
  std::array<FlipPlane, 3> planes;
};

FlipImage opponents_of(const ComparedImage& image) {
  FlipImage result{image.width, image.height, {}};
  const std::size_t pixels = image.rgba.size() / 4;
  for (FlipPlane& plane : result.planes) plane.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const FlipColor color =
        opponent({linear_channel(image.rgba[4 * i]), linear_channel(image.rgba[4 * i + 1]),
                  linear_channel(image.rgba[4 * i + 2])});
    for (std::size_t c = 0; c < 3; ++c) result.planes[c][i] = static_cast<float>(color[c]);
  }
  return result;
}

/// Along rows, then along columns; beyond the border its pixels go on.
FlipPlane convolved(const FlipPlane& plane, std::size_t width, std::size_t height,
                    const Kernel& across, const Kernel& down) {
  const auto pass = [](const FlipPlane& in, std::size_t lines, std::size_t length,
                       std::size_t between_lines, std::size_t between, const Kernel& kernel) {
    const auto radius = static_cast<std::ptrdiff_t>(kernel.size() / 2);
    const auto last = static_cast<std::ptrdiff_t>(length) - 1;
    FlipPlane out(in.size());
    for (std::size_t line = 0; line < lines; ++line) {
      for (std::ptrdiff_t at = 0; at <= last; ++at) {
        double sum = 0.0;
        for (std::ptrdiff_t i = -radius; i <= radius; ++i) {
          const auto from = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at + i, 0, last));
          sum += kernel[static_cast<std::size_t>(i + radius)] *
                 static_cast<double>(in[line * between_lines + from * between]);
        }
        out[line * between_lines + static_cast<std::size_t>(at) * between] =
            static_cast<float>(sum);
      }
    }
    return out;
  };
  return pass(pass(plane, height, width, width, 1, across), width, height, 1, width, down);
}

/// The part exp(-pi² x² / b) of a contrast sensitivity function, and its weight.
struct SensitivityTerm {
  double a, b;
};

Kernel gaussian_term(double b, int radius) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) {
    const double degrees = i / pixels_per_degree;
    kernel.push_back(std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / b));
  }
  return kernel;
}

double sum_of(const Kernel& kernel) {
  double sum = 0.0;
  for (const double value : kernel) sum += value;
  return sum;
}

/// What of a channel is seen from the distance.
FlipPlane seen(const FlipImage& image, std::size_t channel) {
  constexpr std::array<std::array<SensitivityTerm, 2>, 3> sensitivity{
      {{{{1.0, 0.0047}, {0.0, 1e-5}}},
       {{{1.0, 0.0053}, {0.0, 1e-5}}},
       {{{34.1, 0.04}, {13.5, 0.025}}}}};
  const double widest = std::sqrt(0.04 / (2.0 * std::numbers::pi * std::numbers::pi));
  const int radius = static_cast<int>(std::ceil(3.0 * widest * pixels_per_degree));
  FlipPlane result(image.planes[channel].size(), 0.0f);
  double total = 0.0;
  for (const auto& [a, b] : sensitivity[channel]) {
    if (a == 0.0) continue;
    const Kernel kernel = gaussian_term(b, radius);
    const double weight = a * std::sqrt(std::numbers::pi / b);
    total += weight * sum_of(kernel) * sum_of(kernel);
    const FlipPlane part =
        convolved(image.planes[channel], image.width, image.height, kernel, kernel);
    for (std::size_t i = 0; i < part.size(); ++i) result[i] += static_cast<float>(weight) * part[i];
  }
  for (float& value : result) value = static_cast<float>(static_cast<double>(value) / total);
  return result;
}

std::vector<FlipColor> seen_colors(const FlipImage& image) {
  const std::array<FlipPlane, 3> planes{seen(image, 0), seen(image, 1), seen(image, 2)};
  std::vector<FlipColor> colors(planes[0].size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    FlipColor rgb = rgb_of_opponent({planes[0][i], planes[1][i], planes[2][i]});
    for (double& channel : rgb) channel = std::clamp(channel, 0.0, 1.0);
    colors[i] = hunt_lab(rgb);
  }
  return colors;
}

/// Positive weights sum up to 1, negative ones to -1.
Kernel balanced(Kernel kernel) {
  double positive = 0.0, negative = 0.0;
  for (const double value : kernel) (value > 0.0 ? positive : negative) += value;
  for (double& value : kernel) value /= value > 0.0 ? positive : -negative;
  return kernel;
}

enum class Feature { edge, point };

/// The strength of edges or points of the lightness.
FlipPlane strength(const FlipPlane& lightness, const FlipImage& image, Feature feature) {
  const double deviation = 0.5 * feature_width * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0 * deviation));
  Kernel smooth, derivative;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / deviation;
    smooth.push_back(std::exp(-0.5 * x * x));
    derivative.push_back((feature == Feature::edge ? -x : x * x - 1.0) * smooth.back());
  }
  const double sum = sum_of(smooth);
  for (double& value : smooth) value /= sum;
  derivative = balanced(derivative);
  const FlipPlane x = convolved(lightness, image.width, image.height, derivative, smooth);
  const FlipPlane y = convolved(lightness, image.width, image.height, smooth, derivative);
  FlipPlane result(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) result[i] = std::hypot(x[i], y[i]);
  return result;
}

FlipPlane lightness_of(const FlipImage& image) {
  FlipPlane lightness = image.planes[0];
  for (float& value : lightness) value = (value + 16.0f) / 116.0f;
  return lightness;
}

std::vector<double> feature_differences(const FlipImage& a, const FlipImage& b) {
  std::vector<double> differences(a.planes[0].size(), 0.0);
  const FlipPlane of_a = lightness_of(a), of_b = lightness_of(b);
  for (const Feature feature : {Feature::edge, Feature::point}) {
    const FlipPlane in_a = strength(of_a, a, feature), in_b = strength(of_b, b, feature);
    for (std::size_t i = 0; i < differences.size(); ++i) {
      const double difference = std::abs(static_cast<double>(in_a[i]) - in_b[i]);
      differences[i] = std::max(differences[i], difference);
    }
  }
  for (double& value : differences) value = std::pow(value / std::numbers::sqrt2, feature_exponent);
  return differences;
}

}  // namespace

std::vector<float> flip(const ComparedImage& a, const ComparedImage& b) {
  const FlipImage one = opponents_of(a), other = opponents_of(b);
  const std::vector<FlipColor> colors = seen_colors(one), others = seen_colors(other);
  const std::vector<double> features = feature_differences(one, other);
  const double most =
      std::pow(hyab(hunt_lab({0.0, 1.0, 0.0}), hunt_lab({0.0, 0.0, 1.0})), color_exponent);
  const double split = color_split * most;
  std::vector<float> result(colors.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double power = std::pow(hyab(colors[i], others[i]), color_exponent);
    const double color = power < split
                             ? color_share / split * power
                             : color_share + (power - split) / (most - split) * (1.0 - color_share);
    result[i] = static_cast<float>(std::pow(color, 1.0 - features[i]));
  }
  return result;
}

}  // namespace heliograph::cli
