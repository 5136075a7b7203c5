#pragma once

#include <chrono>

namespace heliograph::cli {

/// From now on SIGTSTP, which terminals send at Ctrl-Z and job queues while they wait for others,
/// stops the process as before, and the time until SIGCONT is counted.
void count_stopped_time();

/// How long the process was stopped since.
std::chrono::nanoseconds stopped_time();

}  // namespace heliograph::cli
