#include "tests/support/similarity.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace heliograph::test {
namespace {

constexpr int window = 11;
using Plane = std::vector<double>;

template <typename Values>
Difference compare(const Values& a, const Values& b) {
  if (a.size() != b.size() || a.empty()) throw std::invalid_argument("images differ in size");
  Difference result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 4 == 3) continue;
    const double error = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    result.mean += error;
    // Written so that NaN counts as the largest difference.
    if (!(error <= result.maximum)) {
      result.maximum = std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    }
  }
  result.mean /= static_cast<double>(a.size() / 4 * 3);
  return result;
}

Plane luma(const render::Frame& frame) {
  Plane plane(frame.rgba.size() / 4);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const auto* rgb = &frame.rgba[i * 4];
    plane[i] = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  }
  return plane;
}

std::array<double, window> gaussian() {
  std::array<double, window> weights{};
  double sum = 0.0;
  for (int i = 0; i < window; ++i) {
    const double x = i - window / 2;
    sum += weights[i] = std::exp(-x * x / (2.0 * 1.5 * 1.5));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Gaussian-weighted mean around every pixel whose whole window lies inside.
Plane blurred(const Plane& plane, int width, int height) {
  const auto weights = gaussian();
  const int inner_width = width - window + 1;
  const int inner_height = height - window + 1;
  Plane rows(static_cast<std::size_t>(inner_width * height), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < inner_width; ++x) {
      for (int i = 0; i < window; ++i) {
        rows[y * inner_width + x] += weights[i] * plane[y * width + x + i];
      }
    }
  }
  Plane result(static_cast<std::size_t>(inner_width * inner_height), 0.0);
  for (int y = 0; y < inner_height; ++y) {
    for (int x = 0; x < inner_width; ++x) {
      for (int i = 0; i < window; ++i) {
        result[y * inner_width + x] += weights[i] * rows[(y + i) * inner_width + x];
      }
    }
  }
  return result;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] * b[i];
  return result;
}

}  // namespace

Difference difference(const render::FloatImage& a, const render::FloatImage& b) {
  return compare(a.rgba, b.rgba);
}

Difference difference(const render::Frame& a, const render::Frame& b) {
  return compare(a.rgba, b.rgba);
}

double ssim(const render::Frame& a, const render::Frame& b) {
  const int width = static_cast<int>(a.width);
  const int height = static_cast<int>(a.height);
  if (a.width != b.width || a.height != b.height || width < window || height < window) {
    throw std::invalid_argument("images differ in size or are smaller than the 11 x 11 window");
  }
  const Plane x = luma(a);
  const Plane y = luma(b);
  const auto blur = [&](const Plane& plane) { return blurred(plane, width, height); };
  const Plane mean_x = blur(x), mean_y = blur(y);
  const Plane xx = blur(product(x, x)), yy = blur(product(y, y)), xy = blur(product(x, y));
  constexpr double c1 = (0.01 * 255.0) * (0.01 * 255.0);
  constexpr double c2 = (0.03 * 255.0) * (0.03 * 255.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < mean_x.size(); ++i) {
    const double variances = xx[i] - mean_x[i] * mean_x[i] + yy[i] - mean_y[i] * mean_y[i];
    const double covariance = xy[i] - mean_x[i] * mean_y[i];
    sum += (2.0 * mean_x[i] * mean_y[i] + c1) * (2.0 * covariance + c2) /
           ((mean_x[i] * mean_x[i] + mean_y[i] * mean_y[i] + c1) * (variances + c2));
  }
  return sum / static_cast<double>(mean_x.size());
}

double mean_luminance(const render::FloatImage& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    sum += 0.2126 * image.rgba[i] + 0.7152 * image.rgba[i + 1] + 0.0722 * image.rgba[i + 2];
  }
  return sum / static_cast<double>(image.rgba.size() / 4);
}

}  // namespace heliograph::test
