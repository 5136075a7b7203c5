#include "jobs/render_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace heliograph::jobs {
namespace {

constexpr std::size_t most_error_bytes = 4096;
constexpr int lowest_priority = 19;
constexpr int cannot_start = 127;

[[noreturn]] void throw_cannot_start() {
  throw std::runtime_error(std::string("cannot start a renderer: ") + std::strerror(errno));
}

/// Closes its ends, but for one that was taken.
struct Pipe {
  int read = -1;
  int write = -1;

  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_cannot_start();
    read = ends[0];
    write = ends[1];
  }
  ~Pipe() {
    if (read >= 0) close(read);
    close(write);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int take_read() { return std::exchange(read, -1); }
};

/// Between fork and exec: calls only what is safe there. Files of the server stay closed.
[[noreturn]] void become_renderer(char* const* arguments, const char* folder, int output,
                                  int error) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Never preempts others, and gets a sixtieth of a processor that they use up: jobs wait for
  // sessions, but not without end.
  const struct sched_param unused {};
  sched_setscheduler(0, SCHED_BATCH, &unused);
  setpriority(PRIO_PROCESS, 0, lowest_priority);
  // Waits until the renderer handles it: by default it is lost where the server is alone in its
  // session, as services are.
  sigset_t handled_later;
  sigemptyset(&handled_later);
  sigaddset(&handled_later, SIGTSTP);
  sigprocmask(SIG_SETMASK, &handled_later, nullptr);
  const int input = open("/dev/null", O_RDONLY);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(error, STDERR_FILENO);
  close_range(STDERR_FILENO + 1, ~0U, 0);
  if (chdir(folder) == 0) execv("/proc/self/exe", arguments);
  _exit(cannot_start);
}

/// What can be read now; false at the end.
bool read_available(int file, std::string& text) {
  std::array<char, 4096> buffer{};
  const ssize_t count = read(file, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && (errno == EINTR || errno == EAGAIN));
}

}  // namespace

RenderProcess::RenderProcess(const std::vector<std::string>& arguments,
                             const std::filesystem::path& folder) {
  std::vector<std::string> words{"heliograph"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  Pipe output, error;
  const pid_t pid = fork();
  if (pid == 0) become_renderer(pointers.data(), folder.c_str(), output.write, error.write);
  if (pid < 0) throw_cannot_start();
  output_ = output.take_read();
  error_ = error.take_read();
  pid_ = pid;
  fcntl(error_, F_SETFL, O_NONBLOCK);
}

RenderProcess::~RenderProcess() {
  if (!ended_ && pid_ > 0) {
    kill();
    waitpid(pid_, nullptr, 0);
  }
  close(output_);
  close(error_);
}

std::vector<std::string> RenderProcess::read_lines(int milliseconds) {
  std::array<pollfd, 2> files{{{.fd = output_, .events = POLLIN, .revents = 0},
                               {.fd = error_, .events = POLLIN, .revents = 0}}};
  if (poll(files.data(), files.size(), milliseconds) <= 0) return {};
  if (files[1].revents != 0) read_errors();
  if (files[0].revents == 0) return {};
  if (!read_available(output_, unfinished_line_)) reap();
  std::vector<std::string> lines;
  for (std::size_t end; (end = unfinished_line_.find('\n')) != std::string::npos;) {
    lines.push_back(unfinished_line_.substr(0, end));
    unfinished_line_.erase(0, end + 1);
  }
  return lines;
}

void RenderProcess::read_errors() {
  read_available(error_, errors_);
  if (errors_.size() > most_error_bytes) errors_.erase(0, errors_.size() - most_error_bytes);
}

void RenderProcess::reap() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
  read_errors();
  exit_code_ = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  ended_ = true;
}

void RenderProcess::set_paused(bool paused) {
  if (ended_) return;
  const bool changes = std::exchange(paused_, paused) != paused;
  // Again and again: a renderer that handles SIGTSTP while SIGCONT comes stops itself after it.
  if (!paused) ::kill(pid_, SIGCONT);
  if (paused && changes) ::kill(pid_, SIGTSTP);
}

void RenderProcess::interrupt() {
  if (!ended_) ::kill(pid_, SIGTERM);
  set_paused(false);
}

void RenderProcess::kill() {
  if (!ended_) ::kill(pid_, SIGKILL);
}

}  // namespace heliograph::jobs
