#include "session/library/import_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "scene/import_error.hpp"
#include "session/event_log.hpp"

namespace heliograph::session {
namespace {

[[noreturn]] void throw_system_error(const char* what, int error = errno) {
  throw std::system_error(error, std::generic_category(), what);
}

/// Closes what it holds.
class OwnDescriptor {
 public:
  explicit OwnDescriptor(int descriptor) : descriptor_(descriptor) {}
  ~OwnDescriptor() { reset(); }
  OwnDescriptor(const OwnDescriptor&) = delete;
  OwnDescriptor& operator=(const OwnDescriptor&) = delete;
  int get() const { return descriptor_; }
  int release() { return std::exchange(descriptor_, -1); }
  void reset() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }

 private:
  int descriptor_;
};

/// Files of the server stay closed, and its signals unchanged.
class SpawnSetUp {
 public:
  explicit SpawnSetUp(int socket) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, socket, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
  }
  ~SpawnSetUp() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSetUp(const SpawnSetUp&) = delete;
  SpawnSetUp& operator=(const SpawnSetUp&) = delete;

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

/// Without the tokens that may be in it. What loads libraries, and what tests set, stays.
std::vector<std::string> helper_environment() {
  std::vector<std::string> kept;
  for (char** variable = environ; *variable; ++variable) {
    const std::string_view text = *variable;
    const std::string_view name = text.substr(0, text.find('='));
    if (name.starts_with("LD_") || name.starts_with("HELIOGRAPH_TEST_") ||
        name.ends_with("SAN_OPTIONS")) {
      kept.emplace_back(text);
    }
  }
  return kept;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// False where the helper has ended.
bool send_files(int socket, const std::string& text, std::array<int, 2> files) {
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof files)> control{};
  iovec part{const_cast<char*>(text.data()), text.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* const header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof files);
  std::memcpy(CMSG_DATA(header), files.data(), sizeof files);
  return sendmsg(socket, &message, MSG_NOSIGNAL) == std::ssize(text);
}

/// Everything up to the end, but no more than an answer has.
std::string read_answer(int pipe) {
  std::string text;
  std::array<char, most_import_answer> part{};
  while (text.size() < most_import_answer) {
    const ssize_t count = ::read(pipe, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
  return text;
}

bool receive_end(int socket, ImportEnd& end) {
  ssize_t count = 0;
  while ((count = recv(socket, &end, sizeof end, 0)) < 0 && errno == EINTR) continue;
  return count == static_cast<ssize_t>(sizeof end);
}

struct HelperAnswer {
  std::string text;
  ImportEnd end;
};

/// Nothing where the helper has ended.
std::optional<HelperAnswer> ask_helper(int socket, const std::string& request,
                                       const std::filesystem::path& file) {
  const OwnDescriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.get() < 0) throw_system_error("cannot open the file");
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_system_error("cannot make a pipe");
  const OwnDescriptor incoming(ends[0]);
  OwnDescriptor outgoing(ends[1]);
  if (!send_files(socket, request, {opened.get(), outgoing.get()})) return std::nullopt;
  outgoing.reset();
  HelperAnswer answer;
  answer.text = read_answer(incoming.get());
  if (!receive_end(socket, answer.end)) return std::nullopt;
  return answer;
}

/// What a file does in its own process, it does not write into the log.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

/// Why an import gave no answer; empty: it has.
std::string import_failure(const ImportEnd& end) {
  if (end.late != 0) return "takes longer than " + std::to_string(end.late) + " s";
  if (end.signal == SIGSYS) return "a decoder failed: it called the system for more than its file";
  if (end.signal != 0) return "a decoder failed (signal " + std::to_string(end.signal) + ")";
  return {};
}

}  // namespace

ImportProcess::ImportProcess(std::vector<std::string> arguments)
    : arguments_(std::move(arguments)) {}

void ImportProcess::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  // What waits for its answer sees the end of the pipe; the socket is closed when it is done.
  if (process_ > 0) ::kill(process_, SIGKILL);
}

ImportedFile ImportProcess::import(ImportKind kind, const std::string& name,
                                   const std::filesystem::path& file) {
  const std::string request = static_cast<char>(kind) + name;
  std::optional<HelperAnswer> answer = ask_helper(helper(), request, file);
  if (!answer) {
    // It was killed since the last import, or is being killed.
    end_helper();
    answer = ask_helper(helper(), request, file);
  }
  if (!answer) {
    end_helper();
    throw std::runtime_error("the process that imports files has ended");
  }
  return answer_of(answer->text, answer->end);
}

/// The socket to the helper, which runs.
int ImportProcess::helper() {
  const std::lock_guard lock(mutex_);
  if (stopping_) throw std::runtime_error("the server is shutting down");
  if (process_ < 0) start();
  return socket_;
}

void ImportProcess::start() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw_system_error("cannot make a socket");
  }
  OwnDescriptor own(ends[0]);
  const OwnDescriptor theirs(ends[1]);
  std::vector<std::string> words{"heliograph"};
  words.insert(words.end(), arguments_.begin(), arguments_.end());
  std::vector<std::string> variables = helper_environment();
  const SpawnSetUp set_up(theirs.get());
  const int error = posix_spawn(&process_, "/proc/self/exe", &set_up.actions, &set_up.attributes,
                                pointers_to(words).data(), pointers_to(variables).data());
  if (error != 0) {
    process_ = -1;
    throw_system_error("cannot start a process that imports files", error);
  }
  socket_ = own.release();
}

void ImportProcess::end_helper() {
  const std::lock_guard lock(mutex_);
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
  ::close(std::exchange(socket_, -1));
  process_ = -1;
}

ImportedFile ImportProcess::answer_of(const std::string& text, const ImportEnd& end) {
  if (end.error != 0) throw_system_error("cannot start an import", end.error);
  std::istringstream lines(text);
  std::string word, rest;
  lines >> word;
  if (word == "unconfined") {
    std::getline(lines, rest);
    if (!std::exchange(warned_, true)) {
      log_warning({},
                  "files that are uploaded are imported in processes of their own, but their "
                  "system calls are not restricted:" +
                      on_one_line(rest));
    }
    lines >> word;
  }
  if (const std::string why = import_failure(end); !why.empty()) throw scene::ImportError(why);
  ImportedFile imported;
  if (word == "scene" && lines >> imported.triangles) return imported;
  if (word == "environment" && lines >> imported.width >> imported.height) return imported;
  if (word == "image" && lines >> imported.width >> imported.height) return imported;
  std::getline(lines, rest);
  if (word == "refused" && rest.size() > 1) throw scene::ImportError(on_one_line(rest.substr(1)));
  throw scene::ImportError("a decoder failed");
}

}  // namespace heliograph::session
