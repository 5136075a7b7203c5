#include "tests/bench/table.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/bench/embree_rate.hpp"

namespace heliograph::bench {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void Table::add(const render::Frame& frame) {
  width_ = frame.width;
  height_ = frame.height;
  frames_.push_back(frame.milliseconds);
  for (const render::PassTime& pass : frame.passes) {
    if (pass.name.ends_with(RecordingTracer::pass_suffix)) continue;
    auto& times = times_[pass.name];
    if (times.empty()) order_.push_back({pass.name, pass.kind});
    times.push_back(pass.milliseconds);
  }
}

std::optional<double> Table::median_of_shader(const std::string& name) const {
  const auto pass = std::ranges::find(order_, name, &Pass::name);
  if (pass == order_.end() || pass->kind != protocol::PassKind::device) return std::nullopt;
  return median(times_.at(name));
}

nlohmann::json Table::summary(const std::vector<render::PassWork>& work,
                              const CopyRates& rates) const {
  const double pixels = double{1} * width_ * height_;
  nlohmann::json passes = nlohmann::json::array();
  double sum = 0.0;
  for (const auto& [name, kind] : order_) {
    const double ms = median(times_.at(name));
    sum += ms;
    nlohmann::json pass{{"name", name},
                        {"kind", protocol::enum_name(kind)},
                        {"ms", ms},
                        {"ns_per_pixel", ms * 1e6 / pixels}};
    for (const render::PassWork& done : work) {
      if (done.name != name || ms <= 0.0) continue;
      const double rate = kind == protocol::PassKind::host ? rates.processor : rates.shader;
      if (done.rays > 0)
        pass["million_rays_per_second"] = static_cast<double>(done.rays) / ms / 1e3;
      if (done.image_bytes > 0) {
        const double bytes = static_cast<double>(done.image_bytes);
        pass["image_bytes"] = done.image_bytes;
        pass["times_copy"] = ms * 1e-3 / (bytes / rate);
      }
    }
    passes.push_back(std::move(pass));
  }
  const auto [least, most] = std::minmax_element(frames_.begin(), frames_.end());
  return {{"width", width_},          {"height", height_},
          {"frames", frames_.size()}, {"frame_ms", median(frames_)},
          {"frame_ms_least", *least}, {"frame_ms_most", *most},
          {"passes_ms", sum},         {"passes", passes}};
}

void print(const nlohmann::json& summary) {
  std::printf("%-34s %-6s %9s %9s %9s %9s %7s %8s %7s %8s\n", "pass", "kind", "ms", "ns/pixel",
              "Mray/s", "MB", "x copy", "x Embree", "x loop", "shader x");
  for (const auto& pass : summary.at("passes")) {
    const auto number = [&](const char* key, double scale, int digits) {
      if (!pass.contains(key)) return std::string("-");
      char text[32];
      std::snprintf(text, sizeof text, "%.*f", digits, pass.at(key).get<double>() * scale);
      return std::string(text);
    };
    std::printf("%-34s %-6s %9s %9s %9s %9s %7s %8s %7s %8s\n",
                pass.at("name").get_ref<const std::string&>().c_str(),
                pass.at("kind").get_ref<const std::string&>().c_str(), number("ms", 1, 3).c_str(),
                number("ns_per_pixel", 1, 2).c_str(),
                number("million_rays_per_second", 1, 1).c_str(),
                number("image_bytes", 1e-6, 1).c_str(), number("times_copy", 1, 1).c_str(),
                number("times_embree", 1, 2).c_str(), number("times_bare_loop", 1, 2).c_str(),
                number("shader_times", 1, 1).c_str());
  }
  std::printf("sum of passes %.3f ms; frame %.3f ms (%.3f to %.3f) = %.1f frames/s\n",
              summary.at("passes_ms").get<double>(), summary.at("frame_ms").get<double>(),
              summary.at("frame_ms_least").get<double>(), summary.at("frame_ms_most").get<double>(),
              1e3 / summary.at("frame_ms").get<double>());
}

}  // namespace heliograph::bench
