#include "gpu/pipelines/folder_watch.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

namespace heliograph::gpu {
namespace {

namespace fs = std::filesystem;

// Milliseconds. Without events, as where a filter of system calls forbids them, there is only
// looking. With them, only network file systems need it.
constexpr int look_interval_without_events = 300;
constexpr int look_interval = 10'000;
// Editors write, move and delete several files for one that is saved.
constexpr int settling_time = 30;

constexpr std::uint32_t watched_events =
    IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_CREATE | IN_ONLYDIR;

int make_stop_event() {
  const int event = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (event < 0) throw std::system_error(errno, std::generic_category(), "watch a folder");
  return event;
}

/// A file that was just created is still empty: IN_CLOSE_WRITE follows. Of folders only that tells.
bool is_change(const inotify_event& event) {
  return (event.mask & IN_CREATE) == 0 || (event.mask & IN_ISDIR) != 0;
}

/// Takes all events that there are. @returns whether one is a change
bool take_events(int events) {
  // As many as fit, each with its file's name, inotify(7).
  alignas(inotify_event) std::array<std::byte, 4096> buffer{};
  bool changed = false;
  for (ssize_t size = 0; (size = read(events, buffer.data(), buffer.size())) > 0;) {
    for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
      inotify_event event{};
      std::memcpy(&event, buffer.data() + at, sizeof(event));
      changed |= is_change(event);
      at += sizeof(event) + event.len;
    }
  }
  return changed;
}

}  // namespace

FolderWatch::FolderWatch(fs::path folder)
    : folder_(std::move(folder)),
      stop_(make_stop_event()),
      events_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
  watch_folders();
}

FolderWatch::~FolderWatch() {
  if (events_ >= 0) close(events_);
  close(stop_);
}

/// Those that are watched already stay so.
void FolderWatch::watch_folders() {
  if (events_ < 0) return;
  const auto watch = [this](const fs::path& folder) {
    return inotify_add_watch(events_, folder.c_str(), watched_events) >= 0;
  };
  // Not where the user's processes watch as many folders as they may.
  watches_all_ = watch(folder_);
  std::error_code error;  // a folder may vanish between listing and looking
  for (fs::recursive_directory_iterator entry(folder_, error), end; entry != end && !error;
       entry.increment(error)) {
    std::error_code vanished;
    if (entry->is_directory(vanished)) watches_all_ &= watch(entry->path());
  }
}

/// Of anything, or the end of the time. `stopped` and `changed` become true where that was it.
/// @returns whether there was anything
bool FolderWatch::wait_for_event(int milliseconds, bool& stopped, bool& changed) {
  std::array<pollfd, 2> files{{{stop_, POLLIN, 0}, {events_, POLLIN, 0}}};
  if (poll(files.data(), files.size(), milliseconds) <= 0) return false;
  stopped = files[0].revents != 0;
  if (files[1].revents != 0) changed |= take_events(events_);
  return true;
}

bool FolderWatch::wait() {
  bool stopped = false, changed = false;
  const int interval = watches_all_ ? look_interval : look_interval_without_events;
  while (!changed && !stopped && wait_for_event(interval, stopped, changed)) continue;
  while (changed && !stopped && wait_for_event(settling_time, stopped, changed)) continue;
  // A folder that is new is watched before its files are looked at.
  if (!stopped) watch_folders();
  return !stopped;
}

void FolderWatch::stop() {
  eventfd_write(stop_, 1);
}

}  // namespace heliograph::gpu
