#include "session/library/import_helper.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "scene/environment.hpp"
#include "scene/image/image_decoder.hpp"
#include "scene/import.hpp"
#include "session/library/import_confinement.hpp"

namespace heliograph::session {
namespace {

/// A file to import.
struct ImportRequest {
  ImportKind kind = ImportKind::scene;
  std::string name;
  int file = -1;
  int answer = -1;
};

/// False when the server has ended.
bool receive_request(ImportRequest& request) {
  std::array<char, 256> text{};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(2 * sizeof(int))> control{};
  iovec part{text.data(), text.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  ssize_t count = 0;
  while ((count = recvmsg(STDIN_FILENO, &message, MSG_CMSG_CLOEXEC)) < 0 && errno == EINTR)
    continue;
  const cmsghdr* const files = CMSG_FIRSTHDR(&message);
  if (count < 1 || !files || files->cmsg_len != CMSG_LEN(2 * sizeof(int))) return false;
  request.kind = static_cast<ImportKind>(text[0]);
  request.name.assign(text.data() + 1, static_cast<std::size_t>(count) - 1);
  std::memcpy(&request.file, CMSG_DATA(files), sizeof(int));
  std::memcpy(&request.answer, CMSG_DATA(files) + sizeof(int), sizeof(int));
  return true;
}

/// Everything that the limits allow at the same time, and the program itself.
std::uint64_t most_memory(const scene::ImportLimits& limits) {
  constexpr std::uint64_t program = 512ull << 20;
  constexpr std::uint64_t bytes_per_texel = 6;  // with mip levels
  return program + 2 * limits.file_bytes + limits.unpacked_bytes + 2 * limits.scene_bytes +
         bytes_per_texel * limits.texels;
}

/// An image for textures, completely decoded.
std::string import_image(const std::string& name, const scene::ImportLimits& limits) {
  const std::string label = "the image " + name;
  const std::vector<std::uint8_t> file = scene::read_all({STDIN_FILENO, limits.file_bytes, label});
  try {
    const scene::ImageSize size = scene::probe_image(file);
    const std::uint64_t texels = std::uint64_t(size.width) * size.height;
    if (std::max(size.width, size.height) > limits.texture_size || texels > limits.texels) {
      throw scene::ImportError("is " + std::to_string(size.width) + " x " +
                               std::to_string(size.height) + " pixels: the limit is " +
                               std::to_string(limits.texture_size));
    }
    std::vector<std::uint8_t> rgba(texels * 4);
    scene::decode_image(file, size, rgba);
    return "image " + std::to_string(size.width) + " " + std::to_string(size.height);
  } catch (const scene::ImportError& refusal) {
    throw scene::ImportError(label + " " + refusal.what());
  }
}

std::string import_file(const ImportRequest& request, const scene::ImportLimits& limits) {
  if (request.kind == ImportKind::image) return import_image(request.name, limits);
  if (request.kind == ImportKind::scene) {
    const scene::Scene scene =
        scene::import_lone_gltf({STDIN_FILENO, limits.file_bytes, "the file"}, limits);
    return "scene " + std::to_string(scene.triangle_count());
  }
  const std::string label = "the environment " + request.name;
  try {
    const scene::Environment environment = scene::decode_environment(
        scene::read_all({STDIN_FILENO, scene::most_environment_bytes, label}));
    return "environment " + std::to_string(environment.width) + " " +
           std::to_string(environment.height);
  } catch (const scene::ImportError& refusal) {
    const std::string reason = refusal.what();
    throw scene::ImportError(reason.starts_with(label) ? reason : label + " " + reason);
  }
}

[[noreturn]] void import_and_end(const ImportRequest& request, const scene::ImportLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(request.file, STDIN_FILENO);
  dup2(request.answer, STDOUT_FILENO);
  // A file does not write into the server's log.
  if (const int nothing = ::open("/dev/null", O_WRONLY); nothing >= 0 && !instrumented) {
    dup2(nothing, STDERR_FILENO);
  }
  close_range(STDERR_FILENO + 1, ~0U, 0);
  std::string answer;
  try {
    const std::string unconfined = confine_process(most_memory(limits));
    if (!unconfined.empty()) answer = "unconfined " + unconfined + "\n";
    answer += import_file(request, limits);
  } catch (const std::bad_alloc&) {
    answer += "refused not enough memory for it";
  } catch (const std::exception& refusal) {
    answer += "refused " + std::string(refusal.what());
  }
  answer.resize(std::min(answer.size(), most_import_answer));
  // What a pipe holds is written at once. No destructor is of use any more.
  const ssize_t written = ::write(STDOUT_FILENO, answer.data(), answer.size());
  _exit(written < 0 ? EXIT_FAILURE : EXIT_SUCCESS);
}

/// Ends the process if it takes too long. SIGCHLD is blocked.
ImportEnd wait_for(pid_t process, std::chrono::seconds time) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + time;
  sigset_t ended;
  sigemptyset(&ended);
  sigaddset(&ended, SIGCHLD);
  ImportEnd end;
  int status = 0;
  while (waitpid(process, &status, WNOHANG) != process) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    const timespec pause{left.count() / 1000, left.count() % 1000 * 1'000'000};
    if (left.count() > 0 && (sigtimedwait(&ended, nullptr, &pause) >= 0 || errno == EINTR))
      continue;
    end.late = static_cast<std::int32_t>(time.count());
    ::kill(process, SIGKILL);
    waitpid(process, &status, 0);
    break;
  }
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

ImportEnd import_apart(const ImportRequest& request, const scene::ImportLimits& limits,
                       std::chrono::seconds time) {
  const pid_t process = ::fork();
  if (process == 0) import_and_end(request, limits);
  const ImportEnd failed{.error = errno};
  ::close(request.file);
  ::close(request.answer);
  return process < 0 ? failed : wait_for(process, time);
}

}  // namespace

int run_import_helper(const scene::ImportLimits& limits, std::chrono::seconds time) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t ended;
  sigemptyset(&ended);
  sigaddset(&ended, SIGCHLD);
  sigprocmask(SIG_BLOCK, &ended, nullptr);
  ImportRequest request;
  while (receive_request(request)) {
    const ImportEnd end = import_apart(request, limits, time);
    if (::send(STDIN_FILENO, &end, sizeof end, MSG_NOSIGNAL) < 0) break;
  }
  return 0;
}

}  // namespace heliograph::session
