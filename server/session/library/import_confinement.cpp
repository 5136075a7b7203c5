#include "session/library/import_confinement.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <system_error>
#include <vector>

namespace heliograph::session {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#else
#error "the numbers of system calls are those of x86-64 and of 64-bit ARM"
#endif

/// Memory, threads of this process, time, and what is open already.
constexpr std::uint32_t permitted_calls[] = {
    SYS_read,
    SYS_pread64,
    SYS_write,
    SYS_writev,
    SYS_close,
    SYS_fstat,
    SYS_lseek,
    SYS_munmap,
    SYS_mremap,
    SYS_madvise,
    SYS_brk,
    SYS_futex,
    SYS_rseq,
    SYS_set_robust_list,
    SYS_set_tid_address,
    SYS_sched_yield,
    SYS_sched_getaffinity,
    SYS_getcpu,
    SYS_clock_gettime,
    SYS_clock_nanosleep,
    SYS_nanosleep,
    SYS_gettimeofday,
    SYS_getrandom,
    SYS_getpid,
    SYS_gettid,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_sigaltstack,
    SYS_sysinfo,
    SYS_uname,
    SYS_exit,
    SYS_exit_group,
};

/// Libraries look whether there is something and go on without it. abort() goes on without signals.
constexpr std::uint32_t refused_calls[] = {
    SYS_openat, SYS_faccessat, SYS_readlinkat, SYS_statx,         SYS_getcwd, SYS_ioctl,
    SYS_prctl,  SYS_prlimit64, SYS_mbind,      SYS_get_mempolicy, SYS_tgkill,
#if defined(__x86_64__)
    SYS_open,   SYS_access,    SYS_readlink,   SYS_stat,          SYS_lstat,
#endif
};

using CallFilter = std::vector<sock_filter>;

constexpr std::uint32_t low_word_of_argument(int argument) {
  return offsetof(seccomp_data, args) + sizeof(std::uint64_t) * static_cast<unsigned>(argument);
}

void add_step(CallFilter& filter, std::uint16_t code, std::uint32_t value, std::uint8_t yes = 0,
              std::uint8_t no = 0) {
  filter.push_back({code, yes, no, value});
}

void load_word(CallFilter& filter, std::uint32_t offset) {
  add_step(filter, BPF_LD | BPF_W | BPF_ABS, offset);
}

void end_with(CallFilter& filter, std::uint32_t action) {
  add_step(filter, BPF_RET | BPF_K, action);
}

/// Of the call whose number is loaded.
void answer_call(CallFilter& filter, std::uint32_t call, std::uint32_t action) {
  add_step(filter, BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1);
  end_with(filter, action);
}

/// Permits a call if `bits` of an argument are set, or if none of them is.
void permit_if(CallFilter& filter, std::uint32_t call, int argument, std::uint32_t bits, bool set,
               std::uint32_t otherwise) {
  constexpr std::uint8_t rest = 4;
  add_step(filter, BPF_JMP | BPF_JEQ | BPF_K, call, 0, rest);
  load_word(filter, low_word_of_argument(argument));
  add_step(filter, BPF_JMP | BPF_JSET | BPF_K, bits, set ? 1 : 0, set ? 0 : 1);
  end_with(filter, otherwise);
  end_with(filter, SECCOMP_RET_ALLOW);
}

CallFilter make_filter() {
  CallFilter filter;
  load_word(filter, offsetof(seccomp_data, arch));
  add_step(filter, BPF_JMP | BPF_JEQ | BPF_K, architecture, 1, 0);
  end_with(filter, SECCOMP_RET_KILL_PROCESS);
  load_word(filter, offsetof(seccomp_data, nr));
  for (const std::uint32_t call : permitted_calls) answer_call(filter, call, SECCOMP_RET_ALLOW);
  for (const std::uint32_t call : refused_calls)
    answer_call(filter, call, SECCOMP_RET_ERRNO | EACCES);
  // The C library then calls clone, whose flags can be seen.
  answer_call(filter, SYS_clone3, SECCOMP_RET_ERRNO | ENOSYS);
  permit_if(filter, SYS_clone, 0, CLONE_THREAD, true, SECCOMP_RET_KILL_PROCESS);
  permit_if(filter, SYS_mmap, 2, PROT_EXEC, false, SECCOMP_RET_KILL_PROCESS);
  permit_if(filter, SYS_mprotect, 2, PROT_EXEC, false, SECCOMP_RET_KILL_PROCESS);
  // Of an open file, as the C library asks for it.
  permit_if(filter, SYS_newfstatat, 3, AT_EMPTY_PATH, true, SECCOMP_RET_ERRNO | EACCES);
  end_with(filter, SECCOMP_RET_KILL_PROCESS);
  return filter;
}

void set_limit(int resource, std::uint64_t most) {
  const rlimit limits{most, most};
  if (setrlimit(static_cast<__rlimit_resource>(resource), &limits) != 0) {
    throw std::system_error(errno, std::generic_category(), "setrlimit");
  }
}

}  // namespace

std::string confine_process(std::uint64_t memory_bytes) {
  set_limit(RLIMIT_CORE, 0);
  if (instrumented) return {};
  set_limit(RLIMIT_DATA, memory_bytes);
  // Others of the same user could read its memory, and it theirs.
  prctl(PR_SET_DUMPABLE, 0);
  CallFilter filter = make_filter();
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  const bool restricted = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                          prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  return restricted ? std::string() : std::strerror(errno);
}

}  // namespace heliograph::session
