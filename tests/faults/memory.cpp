// Allocations that fail.
#include <malloc.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "fault_table.hpp"

// The C library's own, which exist under these names for programs that replace malloc.
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
}

namespace {

using heliograph::faults::Function;

bool fails(Function function, const void* caller) {
  const auto outcome = heliograph::faults::outcome_of(
      function, [&](const char* filter) { return heliograph::faults::is_caller(caller, filter); });
  if (outcome.error != 0) errno = outcome.error;
  return outcome.error != 0;
}

void* allocate(std::size_t bytes, std::size_t alignment, const void* caller) {
  void* memory = nullptr;
  if (!fails(Function::operator_new, caller)) {
    memory = alignment == 0 ? __libc_malloc(bytes) : __libc_memalign(alignment, bytes);
  }
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

#define CALLER __builtin_return_address(0)

void* operator new(std::size_t bytes) {
  return allocate(bytes, 0, CALLER);
}
void* operator new[](std::size_t bytes) {
  return allocate(bytes, 0, CALLER);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment), CALLER);
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment), CALLER);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

extern "C" {

void* malloc(std::size_t bytes) noexcept {
  return fails(Function::malloc, CALLER) ? nullptr : __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) noexcept {
  return fails(Function::malloc, CALLER) ? nullptr : __libc_calloc(count, bytes);
}

void* realloc(void* memory, std::size_t bytes) noexcept {
  return fails(Function::malloc, CALLER) ? nullptr : __libc_realloc(memory, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  return fails(Function::malloc, CALLER) ? nullptr : __libc_memalign(alignment, bytes);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) noexcept {
  if (fails(Function::malloc, CALLER)) return ENOMEM;
  void* const found = __libc_memalign(alignment, bytes);
  if (!found) return ENOMEM;
  *memory = found;
  return 0;
}

}  // extern "C"
