#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/api/renderer.hpp"
#include "tests/bench/copy_rate.hpp"

namespace heliograph::bench {

/// Times of many frames per pass, in the order of execution.
class Table {
 public:
  void add(const render::Frame& frame);

  /// Median milliseconds of the pass `name`; nullopt where it never ran as a shader.
  std::optional<double> median_of_shader(const std::string& name) const;

  /// A JSON object: frame_ms (median, minimum, maximum), and per pass median time, ns per pixel,
  /// millions of rays per second, bytes of images, and time relative to copying as many bytes.
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

/// Prints the summary as a table.
void print(const nlohmann::json& summary);

}  // namespace heliograph::bench
