#include "stream/pacing/link_controller.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace heliograph::stream {

using std::chrono::microseconds;
using std::chrono::milliseconds;

namespace {

constexpr double decrease = 0.7;
/// Growth of the budget, as a fraction of a full frame.
constexpr double increase = 1.0 / 12;
constexpr double min_budget = 1500.0;
constexpr milliseconds between_changes{500};
constexpr milliseconds between_increases{1000};
/// Minimum time after a decrease: unsuccessful increases are visible.
constexpr milliseconds before_increase{3000};
/// With a short round trip a frame is not late before this delay, nor before the next frame could
/// arrive, if that interval is short.
constexpr microseconds always_in_time{25'000};
constexpr microseconds max_interval{100'000};
/// A decrease that reduces delays by less than this fraction had no effect.
constexpr double significant = 0.1;
/// Number of arrivals for a reliable mean.
constexpr int arrivals_for_mean = 5;
constexpr double newest_rate_weight = 0.4;
/// A more expensive level has to fit into this fraction of the budget (hysteresis).
constexpr double headroom = 0.85;

struct QualityLevel {
  int scale;       // percent
  double quality;  // fraction of the requested quality
};
constexpr std::array<QualityLevel, 6> jpeg_levels{
    {{100, 1.0}, {100, 0.85}, {100, 0.7}, {75, 0.7}, {50, 0.7}, {50, 0.5}}};
constexpr int min_quality = 10;

/// A video keeps its budget by rate control; below this number of bytes per pixel a smaller frame
/// looks sharper.
struct VideoLevel {
  int scale;
  double least_bytes_per_pixel;
};
constexpr double quality_on_budget = 0.85;
constexpr std::array<VideoLevel, 3> video_levels{{{100, 1.0 / 160}, {75, 1.0 / 320}, {50, 0.0}}};

EncodingVariant at_level(const EncodingVariant& requested, const QualityLevel& level) {
  const int quality = static_cast<int>(std::lround(requested.quality * level.quality));
  return {
      .codec = requested.codec,
      .scale = level.scale,
      .quality = std::clamp(quality, std::min(min_quality, requested.quality), requested.quality)};
}

}  // namespace

void LinkController::Mean::add(double more_bytes, double more_delay) {
  ++count;
  const double weight = std::max(newest_rate_weight, 1.0 / count);
  bytes += weight * (more_bytes - bytes);
  delay += weight * (more_delay - delay);
}

void LinkController::arrived(const Arrival& arrival, Clock::time_point now) {
  const double bytes = static_cast<double>(arrival.bytes);
  const double delay = static_cast<double>(arrival.delay.count());
  base_ = std::min(base_, delay);
  if (arrival.variant.codec == protocol::StreamCodec::jpeg) {
    const double unit = bytes / relative_bytes(arrival.variant);
    unit_bytes_ += (unit_bytes_ == 0.0 ? 1.0 : newest_rate_weight) * (unit - unit_bytes_);
  }
  if (now < settled_at_) return;
  const bool is_late = late(arrival);
  // A decrease is compared with the late arrivals before it, not with earlier ones in time.
  if (is_late != late_) now_ = {};
  late_ = is_late;
  now_.add(bytes, delay);
  if (now < next_change_) return;
  if (evaluating_ && now_.count >= arrivals_for_mean) evaluate_decrease();
  if (is_late) {
    if (now_.count >= arrivals_for_mean && late(arrival)) lower(now);
    return;
  }
  // A frame far below the budget does not show that a larger budget would fit.
  if (budget_ == unlimited || bytes < 0.5 * budget_ || now < next_increase_) return;
  budget_ += increase * std::max(unit_bytes_, bytes);
  next_change_ = now + between_changes;
  next_increase_ = now + between_increases;
}

bool LinkController::late(const Arrival& arrival) const {
  const microseconds tolerance = std::max(always_in_time, std::min(arrival.interval, max_interval));
  const double delay = static_cast<double>(arrival.delay.count());
  return delay > std::max(2.0 * base_, base_ + static_cast<double>(tolerance.count()));
}

void LinkController::lower(Clock::time_point now) {
  before_ = now_;
  budget_before_ = budget_;
  evaluating_ = true;
  budget_ = std::max(min_budget, decrease * std::min(budget_, now_.bytes));
  settled_at_ = now + microseconds(static_cast<std::int64_t>(2.0 * now_.delay));
  next_change_ = std::max(now + between_changes, settled_at_);
  next_increase_ = now + before_increase;
  now_ = {};
}

void LinkController::evaluate_decrease() {
  evaluating_ = false;
  const double bytes_saved = before_.bytes - now_.bytes;
  if (bytes_saved < significant * before_.bytes) return;  // nothing to compare
  const double time_saved = before_.delay - now_.delay;
  // The line through both means, evaluated at a frame of 0 bytes.
  const double empty = now_.delay - time_saved / bytes_saved * now_.bytes;
  base_ = std::clamp(empty, 0.0, now_.delay);
  if (time_saved > significant * before_.delay) return;
  base_ = now_.delay;
  budget_ = budget_before_;
}

microseconds LinkController::base_delay() const {
  return microseconds(static_cast<std::int64_t>(base_));
}

EncodingVariant LinkController::choose(const EncodingVariant& requested, std::uint64_t pixels) {
  if (budget_ == unlimited) {
    level_ = 0;
    return requested;
  }
  if (requested.codec != protocol::StreamCodec::jpeg) {
    level_ = video_level(pixels);
    // A different quality, so that viewers on faster links do not share this viewer's budget.
    return at_level(requested, {.scale = video_levels[level_].scale, .quality = quality_on_budget});
  }
  level_ = jpeg_level(requested);
  return at_level(requested, jpeg_levels[level_]);
}

EncodingVariant LinkController::choose_refining(const EncodingVariant& requested) const {
  const bool limited = budget_ != unlimited && level_ > 0;
  return at_level({.quality = requested.quality}, jpeg_levels[limited ? 2 : 0]);
}

bool LinkController::may_choose(const EncodingVariant& requested, const EncodingVariant& made) {
  return requested.codec == protocol::StreamCodec::jpeg &&
         std::ranges::any_of(jpeg_levels, [&](const QualityLevel& level) {
           return at_level(requested, level) == made;
         });
}

std::size_t LinkController::jpeg_level(const EncodingVariant& requested) const {
  const auto fits = [&](std::size_t level, double budget) {
    return unit_bytes_ * relative_bytes(at_level(requested, jpeg_levels[level])) <= budget;
  };
  std::size_t level = std::min(level_, jpeg_levels.size() - 1);
  while (level + 1 < jpeg_levels.size() && !fits(level, budget_)) ++level;
  while (level > 0 && level <= level_ && fits(level - 1, headroom * budget_)) --level;
  return level;
}

std::size_t LinkController::video_level(std::uint64_t pixels) const {
  const auto fits = [&](std::size_t level, double budget) {
    return static_cast<double>(pixels) * video_levels[level].least_bytes_per_pixel <= budget;
  };
  std::size_t level = std::min(level_, video_levels.size() - 1);
  while (level + 1 < video_levels.size() && !fits(level, budget_)) ++level;
  while (level > 0 && level <= level_ && fits(level - 1, headroom * budget_)) --level;
  return level;
}

}  // namespace heliograph::stream
