#include "scene/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "scene/import_error.hpp"

namespace heliograph::scene {

namespace {

// Of a single read, so that a load can be cancelled in between.
constexpr std::size_t most_bytes_at_once = 8 << 20;

// Non-blocking: opening a pipe must not wait for its writer before its type is checked.
int open_to_read(const std::filesystem::path& path, const std::string& label) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor >= 0) return descriptor;
  throw ImportError(label + (errno == ENOENT ? " does not exist" : " cannot be opened"));
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& path, std::uint64_t max_bytes,
                         std::string label)
    : RegularFile(open_to_read(path, label), max_bytes, label) {}

RegularFile::RegularFile(int descriptor, std::uint64_t max_bytes, std::string label)
    : label_(std::move(label)), descriptor_(descriptor) {
  const auto fail = [&](const std::string& reason) {
    ::close(descriptor_);
    throw ImportError(label_ + reason);
  };
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    fail(" is not a regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
  if (size_ > max_bytes) {
    fail(" has " + std::to_string(size_) + " bytes: the limit on the files of a scene leaves " +
         std::to_string(max_bytes));
  }
}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : label_(std::move(other.label_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RegularFile::read(std::uint64_t offset, std::span<std::uint8_t> bytes,
                       const std::stop_token& stop) const {
  while (!bytes.empty()) {
    throw_if_cancelled(stop);
    const ssize_t count =
        ::pread(descriptor_, bytes.data(), std::min(bytes.size(), most_bytes_at_once),
                static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw ImportError(label_ + " cannot be read completely");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

std::vector<std::uint8_t> read_all(const RegularFile& file, const std::stop_token& stop) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(file.size()));
  file.read(0, bytes, stop);
  return bytes;
}

}  // namespace heliograph::scene
