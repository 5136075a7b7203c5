#include "cli/render/stopped_time.hpp"

#include <atomic>
#include <csignal>

namespace heliograph::cli {
namespace {

using Clock = std::chrono::steady_clock;

// A signal handler has nothing else to keep it in.
std::atomic<std::chrono::nanoseconds::rep> stopped = 0;

void stop(int) {
  const Clock::time_point before = Clock::now();
  raise(SIGSTOP);
  stopped += std::chrono::nanoseconds(Clock::now() - before).count();
}

}  // namespace

void count_stopped_time() {
  struct sigaction action {};
  action.sa_handler = stop;
  action.sa_flags = SA_RESTART;
  sigaction(SIGTSTP, &action, nullptr);
  sigset_t handled;
  sigemptyset(&handled);
  sigaddset(&handled, SIGTSTP);
  pthread_sigmask(SIG_UNBLOCK, &handled, nullptr);
}

std::chrono::nanoseconds stopped_time() {
  return std::chrono::nanoseconds(stopped.load());
}

}  // namespace heliograph::cli
