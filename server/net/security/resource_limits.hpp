#pragma once

#include <filesystem>
#include <optional>

namespace heliograph::net {

/// Limits of this process's control group; absent if it is not limited or cannot be read.
struct ResourceLimits {
  std::optional<double> memory_bytes;
  std::optional<double> processors;  // shares of one processor's time
};

/// Reads both versions of control groups as a container sees its own.
/// `folder` is where they are mounted, /sys/fs/cgroup.
ResourceLimits read_resource_limits(const std::filesystem::path& folder);

/// How many threads can be at work at once without waiting for the next period of the quota: at
/// least one, at most as many as there are processors.
unsigned useful_threads(const ResourceLimits& limits, unsigned processors);

}  // namespace heliograph::net
