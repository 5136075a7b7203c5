#include "stream/pacing/link_controller.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace heliograph::stream {

using std::chrono::microseconds;
using std::chrono::milliseconds;

namespace {

constexpr double decrease = 0.7;
/// Parts of a whole picture by which the budget grows.
constexpr double increase = 1.0 / 12;
constexpr double least_budget = 1500.0;
constexpr milliseconds between_changes{500};
constexpr milliseconds between_increases{1000};
/// How long a decrease lasts at least: trying in vain is seen.
constexpr milliseconds before_increase{3000};
/// On a short way a frame is not late before this, whatever the factor says; nor before the next
/// picture could be there, as long as that is soon.
constexpr microseconds always_in_time{25'000};
constexpr microseconds longest_interval{100'000};
/// A decrease by which delays fall less than this part has not helped.
constexpr double worthwhile = 0.1;
/// So many arrivals make a mean that can be relied on.
constexpr int arrivals_to_judge = 5;
constexpr double newest_rate_weight = 0.4;
/// A dearer form has to fit with some room to spare.
constexpr double room_to_rise = 0.85;

struct Rung {
  int scale;       // percent
  double quality;  // part of the quality that is wanted
};
constexpr std::array<Rung, 6> jpeg_rungs{
    {{100, 1.0}, {100, 0.85}, {100, 0.7}, {75, 0.7}, {50, 0.7}, {50, 0.5}}};
constexpr int least_quality = 10;

/// A video keeps to its budget by itself; with fewer bits than these for a pixel it is blurred less
/// when it is smaller.
struct VideoRung {
  int scale;
  double least_bytes_per_pixel;
};
constexpr double quality_on_budget = 0.85;
constexpr std::array<VideoRung, 3> video_rungs{{{100, 1.0 / 160}, {75, 1.0 / 320}, {50, 0.0}}};

Form on_rung(const Form& wanted, const Rung& rung) {
  const int quality = static_cast<int>(std::lround(wanted.quality * rung.quality));
  return {.codec = wanted.codec,
          .scale = rung.scale,
          .quality = std::clamp(quality, std::min(least_quality, wanted.quality), wanted.quality)};
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
  if (arrival.form.codec == protocol::StreamCodec::jpeg) {
    const double unit = bytes / relative_bytes(arrival.form);
    unit_bytes_ += (unit_bytes_ == 0.0 ? 1.0 : newest_rate_weight) * (unit - unit_bytes_);
  }
  if (now < settled_at_) return;
  const bool is_late = late(arrival);
  // A decrease is compared with what was late before it, not with better times.
  if (is_late != late_) now_ = {};
  late_ = is_late;
  now_.add(bytes, delay);
  if (now < next_change_) return;
  if (judging_ && now_.count >= arrivals_to_judge) judge_decrease();
  if (is_late) {
    if (now_.count >= arrivals_to_judge && late(arrival)) lower(now);
    return;
  }
  // A picture that is far below the budget does not show that more would fit.
  if (budget_ == unlimited || bytes < 0.5 * budget_ || now < next_increase_) return;
  budget_ += increase * std::max(unit_bytes_, bytes);
  next_change_ = now + between_changes;
  next_increase_ = now + between_increases;
}

bool LinkController::late(const Arrival& arrival) const {
  const microseconds patience =
      std::max(always_in_time, std::min(arrival.interval, longest_interval));
  const double delay = static_cast<double>(arrival.delay.count());
  return delay > std::max(2.0 * base_, base_ + static_cast<double>(patience.count()));
}

void LinkController::lower(Clock::time_point now) {
  before_ = now_;
  budget_before_ = budget_;
  judging_ = true;
  budget_ = std::max(least_budget, decrease * std::min(budget_, now_.bytes));
  settled_at_ = now + microseconds(static_cast<std::int64_t>(2.0 * now_.delay));
  next_change_ = std::max(now + between_changes, settled_at_);
  next_increase_ = now + before_increase;
  now_ = {};
}

void LinkController::judge_decrease() {
  judging_ = false;
  const double fewer = before_.bytes - now_.bytes;
  if (fewer < worthwhile * before_.bytes) return;  // nothing to compare
  const double sooner = before_.delay - now_.delay;
  // The straight line through both means, at a picture of no bytes.
  const double empty = now_.delay - sooner / fewer * now_.bytes;
  base_ = std::clamp(empty, 0.0, now_.delay);
  if (sooner > worthwhile * before_.delay) return;
  base_ = now_.delay;
  budget_ = budget_before_;
}

microseconds LinkController::base_delay() const {
  return microseconds(static_cast<std::int64_t>(base_));
}

Form LinkController::choose(const Form& wanted, std::uint64_t pixels) {
  if (budget_ == unlimited) {
    rung_ = 0;
    return wanted;
  }
  if (wanted.codec != protocol::StreamCodec::jpeg) {
    rung_ = video_rung(pixels);
    // Another quality, so that viewers on better ways do not share this one's budget.
    return on_rung(wanted, {.scale = video_rungs[rung_].scale, .quality = quality_on_budget});
  }
  rung_ = jpeg_rung(wanted);
  return on_rung(wanted, jpeg_rungs[rung_]);
}

Form LinkController::resting(const Form& wanted) const {
  const bool narrow = budget_ != unlimited && rung_ > 0;
  return on_rung({.quality = wanted.quality}, jpeg_rungs[narrow ? 2 : 0]);
}

std::size_t LinkController::jpeg_rung(const Form& wanted) const {
  const auto fits = [&](std::size_t rung, double budget) {
    return unit_bytes_ * relative_bytes(on_rung(wanted, jpeg_rungs[rung])) <= budget;
  };
  std::size_t rung = std::min(rung_, jpeg_rungs.size() - 1);
  while (rung + 1 < jpeg_rungs.size() && !fits(rung, budget_)) ++rung;
  while (rung > 0 && rung <= rung_ && fits(rung - 1, room_to_rise * budget_)) --rung;
  return rung;
}

std::size_t LinkController::video_rung(std::uint64_t pixels) const {
  const auto fits = [&](std::size_t rung, double budget) {
    return static_cast<double>(pixels) * video_rungs[rung].least_bytes_per_pixel <= budget;
  };
  std::size_t rung = std::min(rung_, video_rungs.size() - 1);
  while (rung + 1 < video_rungs.size() && !fits(rung, budget_)) ++rung;
  while (rung > 0 && rung <= rung_ && fits(rung - 1, room_to_rise * budget_)) --rung;
  return rung;
}

}  // namespace heliograph::stream
