#include "fault_table.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <unwind.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace heliograph::faults {
namespace {

constexpr auto rows = static_cast<std::size_t>(Function::count);
constexpr std::size_t table_bytes = rows * sizeof(Row);
constexpr const char* names[] = {
#define FUNCTION(name) #name,
#include "fault_functions.def"
};

std::atomic<Row*> table = nullptr;

// Other models allocate memory when a thread first looks at it.
__attribute__((tls_model("initial-exec"))) thread_local bool in_own_call = false;

struct Range {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
  bool contains(const void* address) const {
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    return begin <= at && at < end;
  }
};

Range program, cpp_library, itself;
bool traces = false;

Range code_of(const dl_phdr_info& object) {
  Range range;
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const auto& part = object.dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    range.begin = object.dlpi_addr + part.p_vaddr;
    range.end = range.begin + part.p_memsz;
  }
  return range;
}

int note_object(dl_phdr_info* object, std::size_t, void*) {
  const Range code = code_of(*object);
  if (program.end == 0) program = code;  // the program comes first
  if (std::strstr(object->dlpi_name, "libstdc++")) cpp_library = code;
  if (code.contains(reinterpret_cast<const void*>(&note_object))) itself = code;
  return 0;
}

/// "function[@filter]:first:error[:amount[:times]]", several separated by blanks.
void take_rule(const char* text) {
  char name[64] = {}, *filter = nullptr;
  unsigned long long first = 0, times = 1;
  long long amount = 0;
  int error = 0;
  if (std::sscanf(text, "%63[^:]:%llu:%d:%lld:%llu", name, &first, &error, &amount, &times) < 3) {
    std::fprintf(stderr, "heliograph_faults: not a rule: %s\n", text);
    std::_Exit(EXIT_FAILURE);
  }
  if ((filter = std::strchr(name, '@'))) *filter++ = '\0';
  Row* const begin = table.load();
  for (Row* row = begin; row < begin + rows; ++row) {
    if (std::strcmp(row->name, name) != 0) continue;
    if (filter) std::snprintf(row->filter, sizeof row->filter, "%s", filter);
    row->error = error;
    row->first = first;
    row->times = times;
    row->amount = amount;
    row->armed.store(1, std::memory_order_release);
    return;
  }
  std::fprintf(stderr, "heliograph_faults: no function %s\n", name);
  std::_Exit(EXIT_FAILURE);
}

void take_rules(const char* rules) {
  char text[1024];
  std::snprintf(text, sizeof text, "%s", rules);
  char* rest = nullptr;
  for (char* rule = strtok_r(text, " ", &rest); rule; rule = strtok_r(nullptr, " ", &rest)) {
    take_rule(rule);
  }
}

/// Shared with the test where HELIOGRAPH_TEST_FAULT_TABLE names a file; processes that the program
/// starts count in the same table.
Row* map_table(const char* file) {
  int flags = MAP_PRIVATE | MAP_ANONYMOUS, descriptor = -1;
  if (file) {
    flags = MAP_SHARED;
    descriptor = ::open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    struct stat status {};
    if (descriptor < 0 || ::fstat(descriptor, &status) != 0) return nullptr;
    // Never shorter: the test has mapped it.
    const bool is_short = status.st_size < static_cast<off_t>(table_bytes);
    if (is_short && ::ftruncate(descriptor, table_bytes) != 0) return nullptr;
  }
  void* const memory = ::mmap(nullptr, table_bytes, PROT_READ | PROT_WRITE, flags, descriptor, 0);
  if (descriptor >= 0) ::close(descriptor);
  return memory == MAP_FAILED ? nullptr : static_cast<Row*>(memory);
}

__attribute__((constructor)) void set_up() {
  const OwnCalls guard;
  dl_iterate_phdr(note_object, nullptr);
  traces = std::getenv("HELIOGRAPH_TEST_FAULT_TRACE") != nullptr;
  Row* const mapped = map_table(std::getenv("HELIOGRAPH_TEST_FAULT_TABLE"));
  if (!mapped) return;
  for (std::size_t i = 0; i < rows; ++i) {
    std::snprintf(mapped[i].name, sizeof mapped[i].name, "%s", names[i]);
  }
  table.store(mapped, std::memory_order_release);
  if (const char* const faults = std::getenv("HELIOGRAPH_TEST_FAULTS")) take_rules(faults);
}

/// For HELIOGRAPH_TEST_FAULT_TRACE: who made the call that fails.
void print_callers(const Row& row) {
  void* callers[64];
  const int count = backtrace(callers, 64);
  dprintf(STDERR_FILENO, "heliograph_faults: %s fails in\n", row.name);
  backtrace_symbols_fd(callers, count, STDERR_FILENO);
}

struct OutsideFrame {
  const void* address = nullptr;
  int depth = 0;
};

_Unwind_Reason_Code find_outside(_Unwind_Context* context, void* argument) {
  auto& found = *static_cast<OutsideFrame*>(argument);
  found.address = reinterpret_cast<const void*>(_Unwind_GetIP(context));
  constexpr int deepest = 24;
  const bool inside = cpp_library.contains(found.address) || itself.contains(found.address);
  return inside && ++found.depth < deepest ? _URC_NO_REASON : _URC_END_OF_STACK;
}

}  // namespace

Row* row_of(Function function) {
  Row* const begin = table.load(std::memory_order_acquire);
  return begin ? begin + static_cast<std::size_t>(function) : nullptr;
}

Outcome count_call(Row& row) {
  const std::uint64_t number = ++row.calls;
  if (row.first == 0 || number < row.first || number - row.first >= row.times) return {};
  ++row.injected;
  if (traces) print_callers(row);
  if (row.error != 0) return {.error = row.error};
  return {.amount = row.amount};
}

OwnCalls::OwnCalls() : outermost_(!in_own_call), error_(errno) {
  in_own_call = true;
}

OwnCalls::~OwnCalls() {
  if (outermost_) in_own_call = false;
  errno = error_;
}

bool is_caller(const void* address, const char* filter) {
  if (*filter != '\0') {
    Dl_info object;
    return dladdr(address, &object) != 0 && std::strstr(object.dli_fname, filter) != nullptr;
  }
  if (program.contains(address)) return true;
  if (!cpp_library.contains(address)) return false;
  OutsideFrame found;
  _Unwind_Backtrace(find_outside, &found);
  return program.contains(found.address);
}

bool is_path(const char* path, const char* filter) {
  return path && std::strstr(path, filter) != nullptr;
}

bool is_path_of(int file, const char* filter) {
  if (*filter == '\0') return true;
  char link[64], path[1024];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = ::readlink(link, path, sizeof path - 1);
  if (length < 0) return false;
  path[length] = '\0';
  return is_path(path, filter);
}

}  // namespace heliograph::faults
