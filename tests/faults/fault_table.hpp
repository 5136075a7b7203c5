#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

/// The table of faults that a test shares with the program: a row for each function whose calls can
/// fail. The test writes the rules, the library counts calls and what it injected.
namespace heliograph::faults {

enum class Function {
#define FUNCTION(name) name,
#include "fault_functions.def"
  count
};

/// A row of the table; tests/protocol/harness/faults.py has the same layout.
struct Row {
  char name[32];
  char filter[32];  ///< part of a path, or of the name of the calling library
  std::atomic<std::uint64_t> calls;
  std::atomic<std::uint64_t> injected;
  std::atomic<std::uint32_t> armed;
  std::int32_t error;   ///< errno or VkResult; 0: no error, but `amount`
  std::uint64_t first;  ///< call that fails, from 1 on; 0: calls are counted only
  std::uint64_t times;  ///< how many calls fail
  std::int64_t amount;  ///< bytes that are read or written at most; seconds that a clock is ahead
  std::uint64_t unused[2];
};
static_assert(sizeof(Row) == 128);

/// What a call does instead of what it should.
struct Outcome {
  std::int32_t error = 0;
  std::int64_t amount = std::numeric_limits<std::int64_t>::max();

  /// Of a short read or write.
  std::size_t limit(std::size_t bytes) const {
    return amount < static_cast<std::int64_t>(bytes) ? static_cast<std::size_t>(amount) : bytes;
  }
};

/// Null before the library is set up, and where the program has no table.
Row* row_of(Function function);

/// Counts a call, which matches the row's filter.
Outcome count_call(Row& row);

/// Keeps the calls that the library itself makes out of the count; errno stays.
class OwnCalls {
 public:
  OwnCalls();
  ~OwnCalls();
  OwnCalls(const OwnCalls&) = delete;
  OwnCalls& operator=(const OwnCalls&) = delete;
  /// False within another one.
  bool outermost() const { return outermost_; }

 private:
  bool outermost_;
  int error_;
};

/// `matches(filter)` tells whether the call is one of those that the row is about.
template <class Matches>
Outcome outcome_of(Function function, const Matches& matches) {
  Row* const row = row_of(function);
  if (!row || row->armed.load(std::memory_order_acquire) == 0) return {};
  const OwnCalls guard;
  if (!guard.outermost() || !matches(static_cast<const char*>(row->filter))) return {};
  return count_call(*row);
}

/// Whether the code at this address belongs to the program, also where the C++ library called on
/// its behalf; with a filter, whether it belongs to a library with such a name.
bool is_caller(const void* address, const char* filter);
/// Whether the file of this descriptor has such a path.
bool is_path_of(int file, const char* filter);
bool is_path(const char* path, const char* filter);

/// The function that the program would call without this library.
void* next_function(const char* name);

template <class Type>
Type* next(Type*, const char* name) {
  return reinterpret_cast<Type*>(next_function(name));
}

}  // namespace heliograph::faults

/// The function of this name that comes after the one of this library.
#define HELIOGRAPH_NEXT(function)                                               \
  ([] {                                                                         \
    static const auto found = heliograph::faults::next(&::function, #function); \
    return found;                                                               \
  }())
