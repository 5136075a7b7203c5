#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace heliograph::jobs {

/// A process of this program that renders at the lowest priority: the processors' time goes to
/// interactive sessions first. It ends with the thread that started it.
class RenderProcess {
 public:
  /// `arguments` after the program's name; `folder`: its working folder.
  /// @throws std::runtime_error
  RenderProcess(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  /// Kills it if it still runs.
  ~RenderProcess();
  RenderProcess(const RenderProcess&) = delete;
  RenderProcess& operator=(const RenderProcess&) = delete;

  /// Lines of its standard output that came within the time.
  std::vector<std::string> read_lines(int milliseconds);
  /// Whether it has ended and all its output was read.
  bool ended() const { return ended_; }
  /// After its end: the exit code, or minus the number of the signal.
  int exit_code() const { return exit_code_; }
  /// The last lines of its standard error.
  const std::string& errors() const { return errors_; }
  /// Stops it, or continues it; it does not count the time between against its limits. To be told
  /// several times a second.
  void set_paused(bool paused);
  /// Asks it to end; it goes on if it was paused.
  void interrupt();
  void kill();

 private:
  void read_errors();
  void reap();

  pid_t pid_ = -1;
  int output_ = -1;
  int error_ = -1;
  bool ended_ = false;
  bool paused_ = false;
  int exit_code_ = 0;
  std::string unfinished_line_;
  std::string errors_;
};

}  // namespace heliograph::jobs
