#include "cli/render/render_timings.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "protocol/limits.hpp"

namespace heliograph::cli {
namespace {

constexpr int warm_up_frames = 3;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Times of many frames, pass by pass in the order of the frame.
class Timings {
 public:
  void add(const render::Frame& frame) {
    frame_ms_.push_back(frame.milliseconds);
    for (const render::PassTime& pass : frame.passes) {
      auto& times = passes_[pass.name];
      if (times.empty()) order_.push_back({pass.name, pass.kind});
      times.push_back(pass.milliseconds);
    }
  }

  nlohmann::json json() const {
    nlohmann::json passes = nlohmann::json::array();
    for (const auto& [name, kind] : order_) {
      passes.push_back(
          {{"name", name}, {"kind", protocol::enum_name(kind)}, {"ms", median(passes_.at(name))}});
    }
    return {{"frames", frame_ms_.size()}, {"frame_ms", median(frame_ms_)}, {"passes", passes}};
  }

 private:
  struct Pass {
    std::string name;
    protocol::PassKind kind;
  };
  std::vector<double> frame_ms_;
  std::vector<Pass> order_;
  std::map<std::string, std::vector<double>> passes_;
};

}  // namespace

nlohmann::json measure_passes(render::Renderer& renderer, protocol::Settings settings,
                              std::uint32_t frames) {
  settings.accumulation.max_samples = protocol::max_samples_per_pixel;
  const auto accepted = renderer.set_settings(settings);
  if (!accepted) throw std::runtime_error(accepted.error().message);
  for (int i = 0; i < warm_up_frames; ++i) renderer.render();
  Timings timings;
  for (std::uint32_t i = 0; i < frames; ++i) timings.add(renderer.render());
  return timings.json();
}

}  // namespace heliograph::cli
