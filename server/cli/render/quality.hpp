#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace heliograph::cli {

/// Estimates how similar the mean of a static view's samples is to what infinitely many would give,
/// without knowing that.
///
/// The mean of N samples differs from that of their first half by as much, in the mean of squares,
/// as it differs from the truth: with a variance s of one sample, both have the variance s / N. So
/// the image is kept whenever its samples have doubled, and the difference of the two is the noise.
class QualityEstimate {
 public:
  /// Whether an image of so many samples is to be given to add().
  bool wants(std::uint32_t samples) const { return samples >= next_; }
  /// RGBA, sRGB. The expected structural similarity to the truth, 0 to 1, if the samples before
  /// were half as many.
  std::optional<double> add(std::span<const std::uint8_t> rgba, std::uint32_t width,
                            std::uint32_t samples);

 private:
  std::vector<float> before_;  // luma
  std::uint32_t before_samples_ = 0;
  std::uint32_t next_ = 1;
};

/// The expected structural similarity (Wang et al. 2004, eq. 13) of an image to the truth, from its
/// difference to one that is as far from it as from the truth. Luma, 0 to 255.
///
/// With the noise n and the truth's own variance v in a window, the similarity to the truth is
/// (2 v + C2) / (2 v + n + C2); v is the image's variance less the noise.
double expected_similarity(std::span<const float> image, std::span<const float> other,
                           std::uint32_t width);

}  // namespace heliograph::cli
