#include "net/security/resource_limits.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace heliograph::net {
namespace {

// Version 1 writes the largest multiple of a page for "no limit".
constexpr double no_memory_limit = 9.0e18;

/// The first two numbers of a file; nothing for "max", -1 and files that are not there.
struct Numbers {
  std::optional<double> first;
  std::optional<double> second;
};

Numbers read_numbers(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const auto next = [&]() -> std::optional<double> {
    std::string word;
    if (!(stream >> word) || word.find_first_not_of("0123456789") != std::string::npos) return {};
    return std::stod(word);
  };
  Numbers result;
  result.first = next();
  result.second = next();
  return result;
}

std::optional<double> ratio(std::optional<double> quota, std::optional<double> period) {
  if (!quota || !period || *period <= 0.0) return {};
  return *quota / *period;
}

}  // namespace

ResourceLimits read_resource_limits(const std::filesystem::path& folder) {
  ResourceLimits limits;
  limits.memory_bytes = read_numbers(folder / "memory.max").first;
  if (!limits.memory_bytes) {
    limits.memory_bytes = read_numbers(folder / "memory/memory.limit_in_bytes").first;
  }
  if (limits.memory_bytes && *limits.memory_bytes > no_memory_limit) limits.memory_bytes.reset();

  const Numbers share = read_numbers(folder / "cpu.max");
  limits.processors = ratio(share.first, share.second);
  if (!limits.processors) {
    limits.processors = ratio(read_numbers(folder / "cpu/cpu.cfs_quota_us").first,
                              read_numbers(folder / "cpu/cpu.cfs_period_us").first);
  }
  return limits;
}

unsigned useful_threads(const ResourceLimits& limits, unsigned processors) {
  const double all = std::max(processors, 1u);
  return static_cast<unsigned>(std::clamp(std::ceil(limits.processors.value_or(all)), 1.0, all));
}

}  // namespace heliograph::net
