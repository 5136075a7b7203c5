#include "stream/pacing/encoding_variant.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::stream {

using protocol::StreamCodec;

namespace {

bool cheaper(const EncodingVariant& a, const EncodingVariant& b) {
  const double bytes_a = relative_bytes(a);
  const double bytes_b = relative_bytes(b);
  return bytes_a != bytes_b ? bytes_a < bytes_b : a < b;
}

/// Keeps `count` of the sorted variants: the cheapest, then the most expensive, then the middle.
std::vector<EncodingVariant> keep(const std::vector<EncodingVariant>& variants, std::size_t count) {
  if (variants.size() <= count) return variants;
  if (count == 1) return {variants.front()};
  if (count == 2) return {variants.front(), variants.back()};
  return {variants.front(), variants[variants.size() / 2], variants.back()};
}

}  // namespace

double relative_bytes(const EncodingVariant& variant) {
  // Measured on rendered scenes: a step of 10 in quality is a factor of about 1.35.
  const double by_quality = std::exp(0.03 * (variant.quality - 80));
  // Smaller images have more detail per pixel.
  const double by_size = std::pow(variant.scale / 100.0, 1.6);
  return by_quality * by_size;
}

std::vector<EncodingVariant> reduce_variants(std::vector<EncodingVariant> requested) {
  std::sort(requested.begin(), requested.end(), cheaper);
  requested.erase(std::unique(requested.begin(), requested.end()), requested.end());
  if (requested.size() <= max_variants) return requested;
  std::vector<EncodingVariant> jpeg;
  std::vector<EncodingVariant> video;
  for (const EncodingVariant& variant : requested) {
    (variant.codec == StreamCodec::jpeg ? jpeg : video).push_back(variant);
  }
  const std::size_t videos = std::min(video.size(), jpeg.empty() ? max_variants : max_variants - 1);
  jpeg = keep(jpeg, max_variants - videos);
  video = keep(video, videos);
  jpeg.insert(jpeg.end(), video.begin(), video.end());
  std::sort(jpeg.begin(), jpeg.end(), cheaper);
  return jpeg;
}

EncodingVariant assigned_variant(const std::vector<EncodingVariant>& variants,
                                 const EncodingVariant& requested) {
  std::optional<EncodingVariant> cheapest;
  std::optional<EncodingVariant> best;
  for (const EncodingVariant& variant : variants) {
    if (variant.codec != requested.codec) continue;
    if (!cheapest || cheaper(variant, *cheapest)) cheapest = variant;
    if (!cheaper(requested, variant) && (!best || cheaper(*best, variant))) best = variant;
  }
  return best ? *best : *cheapest;
}

}  // namespace heliograph::stream
