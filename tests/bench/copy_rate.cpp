#include "tests/bench/copy_rate.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "gpu/frame_plan/frame_plan.hpp"
#include "tests/bench/embedded.hpp"

namespace heliograph::bench {
namespace {

constexpr int runs = 24;

double shader_seconds(const gpu::Device& device, VkExtent2D extent) {
  const gpu::ComputeProgram program(device, shaders::copy_image);
  gpu::FramePlan plan(device, extent);
  const auto source = plan.image("source", VK_FORMAT_R32G32B32A32_SFLOAT);
  const auto copy = plan.image("copy", VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("copy", program).read(source).write(copy).dispatch(extent);
  plan.compile();
  double best = 1e9;
  for (int i = 0; i < runs; ++i) {
    plan.execute();
    best = std::min(best, plan.timings()[0].milliseconds * 1e-3);
  }
  return best;
}

double processor_seconds(std::size_t bytes) {
  std::vector<std::byte> source(bytes), copy(bytes);
  constexpr std::size_t piece = 1 << 18;
  double best = 1e9;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    tbb::parallel_for(std::size_t{0}, (bytes + piece - 1) / piece, [&](std::size_t index) {
      const std::size_t first = index * piece;
      std::memcpy(copy.data() + first, source.data() + first, std::min(piece, bytes - first));
    });
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    best = std::min(best, elapsed.count());
  }
  return best;
}

}  // namespace

CopyRates measure_copy_rates(const gpu::Device& device, VkExtent2D extent) {
  const std::size_t bytes = std::size_t{16} * extent.width * extent.height;
  const double both_ways = 2.0 * static_cast<double>(bytes);
  return {both_ways / shader_seconds(device, extent), both_ways / processor_seconds(bytes)};
}

}  // namespace heliograph::bench
