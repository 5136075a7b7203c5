#pragma once

#include <array>
#include <list>
#include <memory>
#include <mutex>
#include <optional>

#include "render/resources/environment/background.hpp"
#include "render/resources/environment/environment_prefilter.hpp"
#include "render/resources/environment/upper_light.hpp"
#include "scene/environment_sun.hpp"

namespace heliograph::render {

/// An environment as a frame looks it up.
struct EnvironmentView {
  const gpu::Image& background;  // what the eye sees
  const EnvironmentMaps& maps;   // what lights
  const std::optional<scene::Sun>& sun;
};

/// An environment on the device, with its sun in it and as a light of its own. Thread safe.
class LitEnvironment {
 public:
  LitEnvironment(const gpu::Device& device, const Programs& programs,
                 std::shared_ptr<const scene::Environment> source);

  const gpu::Device& device() const { return device_; }
  /// What it was made from.
  const std::shared_ptr<const scene::Environment>& source() const { return source_; }
  /// Where there is a sun, the first call that asks for it in the map filters that as well.
  EnvironmentView view(bool separate_sun) const;
  /// What is seen in place of the environment; null where that is the environment as it is. The one
  /// that was asked for last is kept.
  std::shared_ptr<const Background> background(const protocol::Settings::Background& chosen) const;
  /// What comes from above the horizon, without the sun where that is a light of its own.
  std::shared_ptr<const UpperLight> upper_light(bool separate_sun) const;

 private:
  const gpu::Device& device_;
  const Programs& programs_;
  const std::shared_ptr<const scene::Environment> source_;
  std::optional<scene::Sun> sun_;
  EnvironmentMaps sky_;
  std::optional<gpu::Image> background_;
  mutable std::mutex mutex_;
  mutable std::optional<EnvironmentMaps> maps_of_whole_;
  mutable protocol::Settings::Background last_chosen_;
  mutable std::shared_ptr<const Background> last_background_;
  mutable std::array<std::shared_ptr<const UpperLight>, 2> upper_lights_;  // with the sun, without
};

/// Filters every environment once, however many scenes and sessions show it: those of the same
/// content that are in use, and the one that was asked for last. Thread safe.
class EnvironmentCache {
 public:
  EnvironmentCache(const gpu::Device& device, const Programs& programs)
      : device_(device), programs_(programs) {}

  std::shared_ptr<const LitEnvironment> get(std::shared_ptr<const scene::Environment> environment);

 private:
  struct Entry {
    std::uint64_t content;
    std::weak_ptr<const LitEnvironment> environment;
  };
  const gpu::Device& device_;
  const Programs& programs_;
  std::mutex mutex_;
  std::list<Entry> entries_;
  std::shared_ptr<const LitEnvironment> last_;
};

}  // namespace heliograph::render
