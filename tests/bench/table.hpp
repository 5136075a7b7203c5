#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/api/renderer.hpp"
#include "tests/bench/copy_rate.hpp"

namespace heliograph::bench {

/// Times of many frames, pass by pass in the order of the frame.
class Table {
 public:
  void add(const render::Frame& frame);

  /// Median milliseconds of the pass `name`; nothing where it never ran.
  std::optional<double> median_of(const std::string& name) const;

  /// A JSON object: frame_ms (median, least, most), and of every pass its median time, ns per
  /// pixel, millions of rays per second, bytes of images, and how many times longer it takes than
  /// copying as many bytes does.
  nlohmann::json summary(const std::vector<render::PassWork>& work, const CopyRates& rates) const;

 private:
  struct Pass {
    std::string name;
    protocol::PassKind kind;
  };
  std::uint32_t width_ = 0;
  std::uint32_t height_ = 0;
  std::vector<double> frames_;
  std::vector<Pass> order_;
  std::map<std::string, std::vector<double>> times_;
};

/// The summary for people.
void print(const nlohmann::json& summary);

}  // namespace heliograph::bench
