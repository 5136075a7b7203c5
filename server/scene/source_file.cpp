#include "scene/source_file.hpp"

#include <sys/stat.h>

namespace heliograph::scene {

SourceFile examine_file(const std::filesystem::path& path) {
  SourceFile file{.path = path};
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return file;
  file.bytes = static_cast<std::uint64_t>(status.st_size);
  file.modified = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
  file.inode = status.st_ino;
  return file;
}

}  // namespace heliograph::scene
