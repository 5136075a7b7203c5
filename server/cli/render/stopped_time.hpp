#pragma once

#include <chrono>

namespace heliograph::cli {

/// From now on SIGTSTP, which terminals send at Ctrl-Z and job queues while they wait for others,
/// stops the process as before, and the time until SIGCONT is counted. One that was blocked until
/// now stops it at once. Before other threads begin.
void count_stopped_time();

/// How long the process was stopped since.
std::chrono::nanoseconds stopped_time();

}  // namespace heliograph::cli
