#pragma once

#include <filesystem>

namespace heliograph::gpu {

/// Waits for changes of the files in a folder and below it. The system tells of them (inotify), so
/// that nothing is done while no file changes.
class FolderWatch {
 public:
  /// @throws std::system_error where the process has no file left
  explicit FolderWatch(std::filesystem::path folder);
  ~FolderWatch();
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;

  /// Until something was saved, moved or deleted since the last wait, or since the start, and
  /// nothing more for a moment. Network file systems do not tell what other machines change, so
  /// that it also returns now and then: the caller looks at the files.
  /// @returns false after stop()
  bool wait();
  /// Ends the wait, for good. From any thread.
  void stop();

 private:
  void watch_folders();
  bool wait_for_event(int milliseconds, bool& stopped, bool& changed);

  const std::filesystem::path folder_;
  const int stop_;
  const int events_;  // of inotify; -1: the system gives none
  bool watches_all_ = false;
};

}  // namespace heliograph::gpu
