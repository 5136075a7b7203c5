// Operations on files that fail, or read and write less than they should.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>

#include "fault_table.hpp"

namespace {

using heliograph::faults::Function;
using heliograph::faults::Outcome;

Outcome with_path(Function function, const char* path) {
  return heliograph::faults::outcome_of(
      function, [&](const char* filter) { return heliograph::faults::is_path(path, filter); });
}

Outcome with_file(Function function, int file) {
  return heliograph::faults::outcome_of(
      function, [&](const char* filter) { return heliograph::faults::is_path_of(file, filter); });
}

/// True, with errno, where the call fails.
bool fails(const Outcome& outcome) {
  if (outcome.error != 0) errno = outcome.error;
  return outcome.error != 0;
}

/// The mode that follows the flags where a file may be made.
#define MODE_AFTER(flags)                       \
  mode_t mode = 0;                              \
  if (((flags) & (O_CREAT | O_TMPFILE)) != 0) { \
    va_list more;                               \
    va_start(more, flags);                      \
    mode = va_arg(more, mode_t);                \
    va_end(more);                               \
  }

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  MODE_AFTER(flags)
  return fails(with_path(Function::open, path)) ? -1 : HELIOGRAPH_NEXT(open)(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  MODE_AFTER(flags)
  return fails(with_path(Function::open, path)) ? -1 : HELIOGRAPH_NEXT(open64)(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  MODE_AFTER(flags)
  return fails(with_path(Function::open, path))
             ? -1
             : HELIOGRAPH_NEXT(openat)(folder, path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  return fails(with_path(Function::fopen, path)) ? nullptr : HELIOGRAPH_NEXT(fopen)(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  return fails(with_path(Function::fopen, path)) ? nullptr : HELIOGRAPH_NEXT(fopen64)(path, mode);
}

ssize_t read(int file, void* to, std::size_t bytes) {
  const Outcome outcome = with_file(Function::read, file);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(read)(file, to, outcome.limit(bytes));
}

ssize_t pread(int file, void* to, std::size_t bytes, off_t offset) {
  const Outcome outcome = with_file(Function::pread, file);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(pread)(file, to, outcome.limit(bytes), offset);
}

ssize_t pread64(int file, void* to, std::size_t bytes, off64_t offset) {
  const Outcome outcome = with_file(Function::pread, file);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(pread64)(file, to, outcome.limit(bytes), offset);
}

ssize_t write(int file, const void* from, std::size_t bytes) {
  const Outcome outcome = with_file(Function::write, file);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(write)(file, from, outcome.limit(bytes));
}

ssize_t writev(int file, const iovec* parts, int count) {
  const Outcome outcome = with_file(Function::write, file);
  if (fails(outcome)) return -1;
  const bool cut = outcome.limit(parts->iov_len) < parts->iov_len;
  if (cut) return HELIOGRAPH_NEXT(write)(file, parts->iov_base, outcome.limit(parts->iov_len));
  return HELIOGRAPH_NEXT(writev)(file, parts, count);
}

ssize_t pwrite(int file, const void* from, std::size_t bytes, off_t offset) {
  const Outcome outcome = with_file(Function::pwrite, file);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(pwrite)(file, from, outcome.limit(bytes), offset);
}

ssize_t pwrite64(int file, const void* from, std::size_t bytes, off64_t offset) {
  const Outcome outcome = with_file(Function::pwrite, file);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(pwrite64)(file, from, outcome.limit(bytes), offset);
}

int fsync(int file) {
  return fails(with_file(Function::fsync, file)) ? -1 : HELIOGRAPH_NEXT(fsync)(file);
}

int fdatasync(int file) {
  return fails(with_file(Function::fsync, file)) ? -1 : HELIOGRAPH_NEXT(fdatasync)(file);
}

int rename(const char* from, const char* to) noexcept {
  return fails(with_path(Function::rename, to)) ? -1 : HELIOGRAPH_NEXT(rename)(from, to);
}

int ftruncate(int file, off_t bytes) noexcept {
  return fails(with_file(Function::ftruncate, file)) ? -1 : HELIOGRAPH_NEXT(ftruncate)(file, bytes);
}

int ftruncate64(int file, off64_t bytes) noexcept {
  return fails(with_file(Function::ftruncate, file)) ? -1
                                                     : HELIOGRAPH_NEXT(ftruncate64)(file, bytes);
}

int mkdir(const char* path, mode_t mode) noexcept {
  return fails(with_path(Function::mkdir, path)) ? -1 : HELIOGRAPH_NEXT(mkdir)(path, mode);
}

void* mmap(void* at, std::size_t bytes, int access, int flags, int file, off_t offset) noexcept {
  return fails(with_file(Function::mmap, file))
             ? MAP_FAILED
             : HELIOGRAPH_NEXT(mmap)(at, bytes, access, flags, file, offset);
}

void* mmap64(void* at, std::size_t bytes, int access, int flags, int file,
             off64_t offset) noexcept {
  return fails(with_file(Function::mmap, file))
             ? MAP_FAILED
             : HELIOGRAPH_NEXT(mmap64)(at, bytes, access, flags, file, offset);
}

}  // extern "C"
