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
  /// That of the mean of half of the samples, as of the last estimate.
  double half() const { return half_; }

 private:
  std::vector<float> before_;  // luma
  double half_ = 0.0;
  std::uint32_t before_samples_ = 0;
  std::uint32_t next_ = 1;
};

/// How many samples the next frame of a video needs. An estimate takes twice as many as are found
/// to suffice: frames that follow one whose half would have done take that half, and every sixth is
/// estimated again.
class SampleForecast {
 public:
  /// Absent: the frame is to be estimated.
  std::optional<std::uint32_t> next();
  /// Of a frame that was estimated.
  void add(std::uint32_t samples, bool half_suffices);

 private:
  static constexpr int frames = 5;  // from estimate to estimate
  std::uint32_t samples_ = 0;
  int left_ = 0;
};

/// The expected structural similarity (Wang et al. 2004, eq. 13) of an image to the truth, from its
/// difference to one that is as far from it as from the truth. Luma, 0 to 255. With `noise_scale`
/// 2: that of an image with twice its noise.
///
/// With the noise n and the truth's own variance v in a window, the similarity to the truth is
/// (2 v + C2) / (2 v + n + C2); v is the image's variance less the noise.
double expected_similarity(std::span<const float> image, std::span<const float> other,
                           std::uint32_t width, double noise_scale = 1.0);

}  // namespace heliograph::cli
