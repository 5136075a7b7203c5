#include "render/resources/environment/lit_environment.hpp"

#include <cstring>
#include <utility>

#include "shaders/shared/ground.h"

namespace heliograph::render {
namespace {

/// A number for the size and every bit of an environment.
std::uint64_t content_hash(const scene::Environment& environment) {
  // Multiply and rotate, eight bytes at a time (after MurmurHash64A by Appleby).
  constexpr std::uint64_t factor = 0xc6a4a7935bd1e995ull;
  std::uint64_t hash = (std::uint64_t{environment.width} << 32 | environment.height) * factor;
  const auto mix = [&hash](std::uint64_t word) {
    word *= factor;
    word ^= word >> 47;
    hash = (hash ^ word * factor) * factor;
  };
  const auto bytes = std::as_bytes(std::span(environment.radiance));
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, 8);
    mix(word);
  }
  std::uint64_t rest = 0;
  std::memcpy(&rest, bytes.data() + at, bytes.size() - at);
  mix(rest);
  return hash ^ hash >> 47;
}

}  // namespace

LitEnvironment::LitEnvironment(const gpu::Device& device, const Programs& programs,
                               std::shared_ptr<const scene::Environment> source)
    : device_(device), programs_(programs), source_(std::move(source)) {
  scene::SeparatedEnvironment separated = scene::separate_sun(*source_);
  sun_ = separated.sun;
  sky_ = prefilter_environment(device, programs, separated.sky);
  if (!sun_) return;
  background_ = upload_environment(device, *source_);
}

EnvironmentView LitEnvironment::view(bool separate_sun) const {
  static const std::optional<scene::Sun> none;
  if (!sun_) return {sky_.map, sky_, none};
  if (separate_sun) return {*background_, sky_, sun_};
  const std::lock_guard lock(mutex_);
  if (!maps_of_whole_) maps_of_whole_ = prefilter_environment(device_, programs_, *source_);
  return {*background_, *maps_of_whole_, none};
}

std::shared_ptr<const Background> LitEnvironment::background(
    const protocol::Settings::Background& chosen) const {
  if (chosen.show == protocol::BackgroundKind::environment) return nullptr;
  const std::lock_guard lock(mutex_);
  if (!last_background_ || last_chosen_ != chosen) {
    last_background_ =
        std::make_shared<const Background>(device_, background_map(*source_, chosen));
    last_chosen_ = chosen;
  }
  return last_background_;
}

std::shared_ptr<const UpperLight> LitEnvironment::upper_light(bool separate_sun) const {
  const bool without = separate_sun && sun_.has_value();
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const UpperLight>& light = upper_lights_[without];
  if (!light) {
    light = std::make_shared<const UpperLight>(
        without ? render::upper_light(scene::separate_sun(*source_).sky, shared::ground_lights)
                : render::upper_light(*source_, shared::ground_lights));
  }
  return light;
}

std::shared_ptr<const LitEnvironment> EnvironmentCache::get(
    std::shared_ptr<const scene::Environment> environment) {
  const std::uint64_t content = content_hash(*environment);
  const std::lock_guard lock(mutex_);
  entries_.remove_if([](const Entry& entry) { return entry.environment.expired(); });
  for (const Entry& entry : entries_) {
    if (entry.content != content) continue;
    last_ = entry.environment.lock();
    if (last_) return last_;
  }
  last_ = std::make_shared<const LitEnvironment>(device_, programs_, std::move(environment));
  entries_.push_back({content, last_});
  return last_;
}

}  // namespace heliograph::render
