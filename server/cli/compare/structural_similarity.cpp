#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cli/compare/image_difference.hpp"

namespace heliograph::cli {
namespace {

constexpr int ssim_window = 11;
constexpr double ssim_deviation = 1.5;
constexpr double ssim_c1 = (0.01 * 255) * (0.01 * 255);
constexpr double ssim_c2 = (0.03 * 255) * (0.03 * 255);

/// Rec. 601.
std::vector<double> luma_plane(const ComparedImage& image) {
  std::vector<double> luma(image.rgba.size() / 4);
  for (std::size_t i = 0; i < luma.size(); ++i) {
    luma[i] =
        0.299 * image.rgba[4 * i] + 0.587 * image.rgba[4 * i + 1] + 0.114 * image.rgba[4 * i + 2];
  }
  return luma;
}

std::vector<double> window_weights(int size) {
  std::vector<double> weights(static_cast<std::size_t>(size));
  double sum = 0.0;
  for (int i = 0; i < size; ++i) {
    const double x = i - 0.5 * (size - 1);
    sum += weights[static_cast<std::size_t>(i)] =
        std::exp(-x * x / (2.0 * ssim_deviation * ssim_deviation));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Weighted means of a product of two planes around each pixel whose window lies inside.
class Windows {
 public:
  Windows(std::size_t width, std::size_t height)
      : width_(width),
        height_(height),
        across_(window_weights(static_cast<int>(std::min<std::size_t>(ssim_window, width)))),
        down_(window_weights(static_cast<int>(std::min<std::size_t>(ssim_window, height)))) {}

  std::vector<double> mean(const std::vector<double>& a, const std::vector<double>* b) const {
    const std::size_t inner = width_ - across_.size() + 1;
    std::vector<double> rows(inner * height_, 0.0);
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < inner; ++x) {
        for (std::size_t i = 0; i < across_.size(); ++i) {
          const std::size_t at = y * width_ + x + i;
          rows[y * inner + x] += across_[i] * a[at] * (b ? (*b)[at] : 1.0);
        }
      }
    }
    std::vector<double> means(inner * (height_ - down_.size() + 1), 0.0);
    for (std::size_t at = 0; at < means.size(); ++at) {
      for (std::size_t i = 0; i < down_.size(); ++i) means[at] += down_[i] * rows[at + i * inner];
    }
    return means;
  }

 private:
  std::size_t width_, height_;
  std::vector<double> across_, down_;
};

}  // namespace

double structural_similarity(const ComparedImage& a, const ComparedImage& b) {
  const std::vector<double> x = luma_plane(a), y = luma_plane(b);
  const Windows windows(a.width, a.height);
  const auto mean_x = windows.mean(x, nullptr), mean_y = windows.mean(y, nullptr);
  const auto xx = windows.mean(x, &x), yy = windows.mean(y, &y), xy = windows.mean(x, &y);
  double sum = 0.0;
  for (std::size_t i = 0; i < mean_x.size(); ++i) {
    const double variances = xx[i] - mean_x[i] * mean_x[i] + yy[i] - mean_y[i] * mean_y[i];
    const double covariance = xy[i] - mean_x[i] * mean_y[i];
    const double means = mean_x[i] * mean_x[i] + mean_y[i] * mean_y[i];
    sum += (2.0 * mean_x[i] * mean_y[i] + ssim_c1) * (2.0 * covariance + ssim_c2) /
           ((means + ssim_c1) * (variances + ssim_c2));
  }
  return sum / static_cast<double>(mean_x.size());
}

}  // namespace heliograph::cli
