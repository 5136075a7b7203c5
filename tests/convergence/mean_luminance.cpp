#include "tests/convergence/mean_luminance.hpp"

#include <cmath>
#include <stdexcept>

#include "tests/support/similarity.hpp"

namespace heliograph::test {
namespace {

double mean(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

RelativeDifference relative_difference(std::span<const double> got,
                                       std::span<const double> expected) {
  if (got.size() != expected.size() || got.size() < 2) {
    throw std::invalid_argument("two blocks of each are the least that tell an error");
  }
  const double truth = mean(expected);
  const double difference = mean(got) - truth;
  double squares = 0.0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const double deviation = got[i] - expected[i] - difference;
    squares += deviation * deviation;
  }
  const double count = static_cast<double>(got.size());
  return {difference / truth, std::sqrt(squares / (count * (count - 1.0))) / truth};
}

std::vector<double> mean_luminances(render::Renderer& renderer, protocol::Settings settings,
                                    int first, int end, std::uint32_t samples) {
  std::vector<double> means;
  for (int seed = first; seed < end; ++seed) {
    settings.sampling.seed = seed;
    if (!renderer.set_settings(settings)) throw std::runtime_error("settings refused");
    while (renderer.render().samples < samples) {
    }
    means.push_back(mean_luminance(renderer.capture("accumulated").value()));
    if (!std::isfinite(means.back())) throw std::runtime_error("a pixel is no number");
  }
  return means;
}

}  // namespace heliograph::test
