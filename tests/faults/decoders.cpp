// A decoder that does what damaged or hostile files make faulty ones do. It stands for all of them.
#include <sys/socket.h>
#include <sys/syscall.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "fault_table.hpp"

namespace {

using heliograph::faults::Function;
using heliograph::faults::Outcome;

/// Takes more memory than any import may have, and gives up where there is none.
void take_memory() {
  constexpr std::size_t part = std::size_t{64} << 20;
  constexpr int parts = 1024;
  for (int i = 0; i < parts; ++i) {
    if (!std::malloc(part)) std::abort();
  }
}

/// `error`: the signal that would end the process, or ENOMEM.
void misbehave(int error) {
  switch (error) {
    case SIGSEGV:
      *static_cast<volatile int*>(nullptr) = 0;
      return;
    case SIGSYS:
      syscall(SYS_socket, AF_INET, SOCK_STREAM, 0);
      return;
    case SIGXCPU:
      for (volatile bool endless = true; endless;) continue;
      return;
    case ENOMEM:
      take_memory();
      return;
    default:
      return;
  }
}

}  // namespace

extern "C" int tjDecompressHeader3(tjhandle handle, const unsigned char* file, unsigned long bytes,
                                   int* width, int* height, int* sampling, int* colors) {
  const Outcome outcome =
      heliograph::faults::outcome_of(Function::decoder, [](const char*) { return true; });
  misbehave(outcome.error);
  return HELIOGRAPH_NEXT(tjDecompressHeader3)(handle, file, bytes, width, height, sampling, colors);
}
