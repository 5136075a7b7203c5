#include "render/kernels/post/defocus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "render/kernels/common/parallel.hpp"

namespace heliograph::render::kernels {
namespace {

constexpr float beyond_all = 1e30f;    // metres
constexpr float smallest_blur = 0.5f;  // pixels: what is less blurred is sharp
constexpr float golden_angle = 2.39996323f;
constexpr float full_turn = 6.28318531f;
constexpr int rows_at_once = 8;
constexpr auto samples = static_cast<std::size_t>(shared::defocus_samples);

/// Circles of confusion: shaders/lib/lens/defocus.glsl.
class Lens {
 public:
  explicit Lens(const shared::FrameConstants& frame)
      : focus(frame.focus_distance),
        nearness_(1.0f / frame.focus_distance),
        limit_(static_cast<float>(frame.extent.y) / shared::defocus_limit) {
    const float footprint = 2.0f * std::abs(frame.unproject.y) / static_cast<float>(frame.extent.y);
    scale_ = frame.lens_radius / footprint;
  }

  /// Pixels.
  float blur_radius(float distance) const {
    return std::min(scale_ * std::abs(nearness_ - 1.0f / distance), limit_);
  }

  const float focus;  // metres

 private:
  float nearness_;
  float limit_;
  float scale_;
};

float distance_of(const glm::vec4& motion) {
  return motion.w > 0.0f ? motion.w : beyond_all;
}

float fraction(float v) {
  return v - std::floor(v);
}

/// A point of a circle, in radii: a sunflower's, turned by noise.
struct CirclePoint {
  glm::vec2 at;
  float away;
};

/// The circles of all pixels. Noise has so many levels here that no pattern is seen.
class Circles {
 public:
  static constexpr std::size_t levels = 256;

  Circles() : points_(levels * samples) {
    for (std::size_t level = 0; level < levels; ++level) {
      const float noise = (static_cast<float>(level) + 0.5f) / levels;
      for (std::size_t i = 0; i < samples; ++i) {
        const auto number = static_cast<float>(i);
        const float away = std::sqrt((number + noise) / samples);
        const float angle = golden_angle * number + full_turn * noise;
        points_[level * samples + i] = {away * glm::vec2(std::cos(angle), std::sin(angle)), away};
      }
    }
  }

  const CirclePoint* turned_by(float noise) const {
    const auto level = static_cast<std::size_t>(noise * static_cast<float>(levels));
    return points_.data() + std::min(level, levels - 1) * samples;
  }

 private:
  std::vector<CirclePoint> points_;
};

/// The same in every frame.
const Circles& all_circles() {
  static const Circles circles;
  return circles;
}

/// The colours of a pixel: denoised, and where there are any, noisy.
struct Light {
  glm::vec4 hdr{0.0f};
  glm::vec4 noisy{0.0f};

  void add(float weight, const Light& other) {
    hdr += weight * other.hdr;
    noisy += weight * other.noisy;
  }
  Light scaled(float factor) const { return {hdr * factor, noisy * factor}; }
};

/// shaders/lib/lens/defocus_gather.glsl.
class Gather {
 public:
  explicit Gather(const DefocusGatherJob& job)
      : job_(job),
        lens_(job.frame),
        width_(static_cast<int>(job.frame.extent.x)),
        height_(static_cast<int>(job.frame.extent.y)),
        tiles_(shared::defocus_tiles(job.frame.extent)),
        tile_(static_cast<int>(shared::defocus_tile(job.frame.extent))),
        noise_shift_(5.588238f * static_cast<float>(job.frame.sample_index % 64u)),
        points_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
    for_each_range(height_, rows_at_once, [this](int first, int last) {
      for (int y = first; y < last; ++y) list_points(y);
    });
  }

  void row(int y) const {
    const auto line = static_cast<std::uint32_t>(y);
    auto* const blurred = job_.blurred.row<glm::vec4>(line);
    auto* const noisy = job_.blurred_noisy ? job_.blurred_noisy.row<glm::vec4>(line) : nullptr;
    for (int x = 0; x < width_; ++x) {
      const Light shown = through_lens({x, y});
      blurred[x] = shown.hdr;
      if (noisy) noisy[x] = shown.noisy;
    }
  }

 private:
  /// What a pixel shows.
  struct Point {
    float distance;  // along the view, metres
    float circle;    // its radius, pixels
  };
  struct Met {
    glm::ivec2 pixel;
    Point point;
  };

  std::size_t index(glm::ivec2 p) const {
    return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(p.x);
  }

  void list_points(int y) {
    const auto* const motion = job_.motion.row<const glm::vec4>(static_cast<std::uint32_t>(y));
    Point* const row = &points_[index({0, y})];
    for (int x = 0; x < width_; ++x) {
      const float distance = distance_of(motion[x]);
      row[x] = {distance, lens_.blur_radius(distance)};
    }
  }

  Light light_at(glm::ivec2 p) const {
    const auto y = static_cast<std::uint32_t>(p.y);
    Light light{job_.hdr.row<const glm::vec4>(y)[p.x]};
    if (job_.noisy) light.noisy = job_.noisy.row<const glm::vec4>(y)[p.x];
    return light;
  }

  float gradient_noise(glm::ivec2 p) const {
    const glm::vec2 at = glm::vec2(p) + noise_shift_;
    return fraction(52.9829189f * fraction(0.06711056f * at.x + 0.00583715f * at.y));
  }

  float reach_of_front(glm::ivec2 pixel) const {
    const glm::ivec2 tile = pixel / tile_, count(tiles_);
    const glm::ivec2 first = glm::max(tile - 2, 0), last = glm::min(tile + 2, count - 1);
    float largest = 0.0f;
    for (int y = first.y; y <= last.y; ++y) {
      const float* const row = job_.reach + y * count.x;
      largest = std::max(largest, *std::max_element(row + first.x, row + last.x + 1));
    }
    return largest;
  }

  Met met_at(glm::ivec2 pixel, float radius, const CirclePoint& point) const {
    const glm::vec2 at = glm::floor(glm::vec2(pixel) + 0.5f + radius * point.at);
    const glm::ivec2 p = glm::clamp(glm::ivec2(at), glm::ivec2(0), {width_ - 1, height_ - 1});
    return {p, points_[index(p)]};
  }

  /// 0 where a distance is no nearer than the pixel's own, 1 where it clearly is.
  static float in_front(float distance, float own) {
    return std::clamp((own - distance) / (shared::defocus_parting * own), 0.0f, 1.0f);
  }

  float weight_behind(const Point& point, float own, float away) const {
    if (point.distance >= own) return 1.0f;
    const bool reaches = point.distance > lens_.focus && away <= point.circle + smallest_blur;
    return reaches ? 1.0f : 1.0f - in_front(point.distance, own);
  }

  float weight_in_front(const Point& point, float own, float away, float radius) const {
    if (point.distance >= std::min(lens_.focus, own)) return 0.0f;
    if (away > point.circle + smallest_blur) return 0.0f;
    const float scale = radius / std::max(point.circle, 1.0f);
    return in_front(point.distance, own) * scale * scale / static_cast<float>(samples);
  }

  Light behind_and_level(glm::ivec2 pixel, const Point& own, const CirclePoint* circle) const {
    Light sum = light_at(pixel);
    float weights = 1.0f;
    for (std::size_t i = 0; own.circle > smallest_blur && i < samples; ++i) {
      const Met met = met_at(pixel, own.circle, circle[i]);
      const float weight = weight_behind(met.point, own.distance, own.circle * circle[i].away);
      if (weight <= 0.0f) continue;
      sum.add(weight, light_at(met.pixel));
      weights += weight;
    }
    return sum.scaled(1.0f / weights);
  }

  /// `covered`: the share of the pixel that is covered.
  Light front_of(glm::ivec2 pixel, float own, const CirclePoint* circle, float& covered) const {
    Light sum;
    const float radius = reach_of_front(pixel);
    for (std::size_t i = 0; radius > smallest_blur && i < samples; ++i) {
      const Met met = met_at(pixel, radius, circle[i]);
      const float weight = weight_in_front(met.point, own, radius * circle[i].away, radius);
      if (weight <= 0.0f) continue;
      sum.add(weight, light_at(met.pixel));
      covered += weight;
    }
    return covered > 0.0f ? sum.scaled(1.0f / covered) : sum;
  }

  Light through_lens(glm::ivec2 pixel) const {
    const Point& own = points_[index(pixel)];
    const CirclePoint* const circle = circles_.turned_by(gradient_noise(pixel));
    float covered = 0.0f;
    const Light front = front_of(pixel, own.distance, circle, covered);
    covered = std::min(covered, 1.0f);
    Light shown = behind_and_level(pixel, own, circle).scaled(1.0f - covered);
    shown.add(covered, front);
    return shown;
  }

  const DefocusGatherJob& job_;
  Lens lens_;
  int width_;
  int height_;
  glm::uvec2 tiles_;
  int tile_;
  float noise_shift_;
  const Circles& circles_ = all_circles();
  std::vector<Point> points_;
};

}  // namespace

void defocus_reach(const DefocusReachJob& job) {
  const glm::uvec2 extent = job.frame.extent;
  const glm::uvec2 tiles = shared::defocus_tiles(extent);
  const std::uint32_t side = shared::defocus_tile(extent);
  const Lens lens(job.frame);
  const auto row_of_tiles = [&](std::uint32_t row) {
    float* const reach = job.reach + row * tiles.x;
    std::fill_n(reach, tiles.x, 0.0f);
    for (std::uint32_t y = row * side; y < std::min((row + 1) * side, extent.y); ++y) {
      const auto* const motion = job.motion.row<const glm::vec4>(y);
      for (std::uint32_t x = 0; x < extent.x; ++x) {
        const float distance = distance_of(motion[x]);
        float& largest = reach[x / side];
        if (distance < lens.focus) largest = std::max(largest, lens.blur_radius(distance));
      }
    }
  };
  for_each_range(static_cast<int>(tiles.y), 1, [&](int first, int last) {
    for (int row = first; row < last; ++row) row_of_tiles(static_cast<std::uint32_t>(row));
  });
}

void defocus_gather(const DefocusGatherJob& job) {
  const Gather gather(job);
  for_each_range(static_cast<int>(job.frame.extent.y), rows_at_once, [&](int first, int last) {
    for (int y = first; y < last; ++y) gather.row(y);
  });
}

}  // namespace heliograph::render::kernels
