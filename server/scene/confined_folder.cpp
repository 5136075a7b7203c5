#include "scene/confined_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "scene/import_error.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

class FileDescriptor {
 public:
  explicit FileDescriptor(int value) : value_(value) {}
  ~FileDescriptor() {
    if (value_ >= 0) ::close(value_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return value_; }

 private:
  int value_;
};

bool is_inside(const std::filesystem::path& path, const std::filesystem::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

}  // namespace

ConfinedFolder::ConfinedFolder(const std::filesystem::path& folder, std::uint64_t byte_budget)
    : budget_(byte_budget) {
  std::error_code error;
  root_ = std::filesystem::canonical(folder.empty() ? "." : folder, error);
  if (error) throw ImportError("the scene's folder cannot be opened");
}

std::vector<std::uint8_t> ConfinedFolder::read(const std::string& relative) {
  const std::string label = in_quotes(relative);
  const auto outside = [&] { throw ImportError(label + " is outside the scene's folder"); };
  if (relative.find('\0') != std::string::npos)
    throw ImportError("a file name contains a zero byte");
  const std::filesystem::path requested(relative);
  if (requested.is_absolute() || !is_inside((root_ / requested).lexically_normal(), root_))
    outside();
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(root_ / requested, error);
  if (error) throw ImportError(label + " is missing");
  if (!is_inside(resolved, root_)) outside();
  files_.push_back(examine_file(resolved));
  std::vector<std::uint8_t> bytes = read_regular_file(resolved, budget_, label);
  budget_ -= bytes.size();
  return bytes;
}

std::vector<std::uint8_t> read_regular_file(const std::filesystem::path& path,
                                            std::uint64_t max_bytes, const std::string& label) {
  // Non-blocking: opening a pipe must not wait for its writer before its type is checked.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) {
    throw ImportError(label + (errno == ENOENT ? " does not exist" : " cannot be opened"));
  }
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw ImportError(label + " is not a regular file");
  }
  if (static_cast<std::uint64_t>(status.st_size) > max_bytes) {
    throw ImportError(label + " exceeds the limit on the size of a scene's files");
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(status.st_size));
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw ImportError(label + " cannot be read completely");
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

}  // namespace heliograph::scene
