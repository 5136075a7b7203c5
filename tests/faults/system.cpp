// Sockets, processes, threads and clocks that fail.
#include <pthread.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <ctime>

#include "fault_table.hpp"

namespace {

using heliograph::faults::Function;
using heliograph::faults::Outcome;

Outcome by_caller(Function function, const void* caller) {
  return heliograph::faults::outcome_of(
      function, [&](const char* filter) { return heliograph::faults::is_caller(caller, filter); });
}

bool fails(const Outcome& outcome) {
  if (outcome.error != 0) errno = outcome.error;
  return outcome.error != 0;
}

/// A message of which only the first `bytes` of its first part are read or written.
msghdr cut(const msghdr& message, const Outcome& outcome, iovec& first) {
  msghdr shorter = message;
  if (message.msg_iovlen == 0) return shorter;
  first = message.msg_iov[0];
  if (outcome.limit(first.iov_len) == first.iov_len) return shorter;
  first.iov_len = outcome.limit(first.iov_len);
  shorter.msg_iov = &first;
  shorter.msg_iovlen = 1;
  return shorter;
}

/// Seconds that the clock of the day is ahead, for everything in the process.
std::int64_t jump() {
  const auto everywhere = [](const char*) { return true; };
  const Outcome outcome = heliograph::faults::outcome_of(Function::clock_gettime, everywhere);
  return outcome.amount == Outcome().amount ? 0 : outcome.amount;
}

}  // namespace

#define CALLER __builtin_return_address(0)

extern "C" {

int socket(int domain, int type, int protocol) noexcept {
  return fails(by_caller(Function::socket, CALLER))
             ? -1
             : HELIOGRAPH_NEXT(socket)(domain, type, protocol);
}

/// Only what restricts system calls fails.
int prctl(int option, ...) noexcept {
  va_list more;
  va_start(more, option);
  unsigned long values[4];
  for (unsigned long& value : values) value = va_arg(more, unsigned long);
  va_end(more);
  if (option == PR_SET_SECCOMP && fails(by_caller(Function::prctl, CALLER))) return -1;
  return HELIOGRAPH_NEXT(prctl)(option, values[0], values[1], values[2], values[3]);
}

int accept(int listener, sockaddr* address, socklen_t* bytes) {
  return fails(by_caller(Function::accept, CALLER))
             ? -1
             : HELIOGRAPH_NEXT(accept)(listener, address, bytes);
}

int accept4(int listener, sockaddr* address, socklen_t* bytes, int flags) {
  return fails(by_caller(Function::accept, CALLER))
             ? -1
             : HELIOGRAPH_NEXT(accept4)(listener, address, bytes, flags);
}

ssize_t recv(int socket, void* to, std::size_t bytes, int flags) {
  const Outcome outcome = by_caller(Function::recvmsg, CALLER);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(recv)(socket, to, outcome.limit(bytes), flags);
}

ssize_t recvmsg(int socket, msghdr* message, int flags) {
  const Outcome outcome = by_caller(Function::recvmsg, CALLER);
  if (fails(outcome)) return -1;
  iovec first;
  msghdr shorter = cut(*message, outcome, first);
  const ssize_t count = HELIOGRAPH_NEXT(recvmsg)(socket, &shorter, flags);
  message->msg_flags = shorter.msg_flags;
  message->msg_namelen = shorter.msg_namelen;
  message->msg_controllen = shorter.msg_controllen;
  return count;
}

ssize_t send(int socket, const void* from, std::size_t bytes, int flags) {
  const Outcome outcome = by_caller(Function::sendmsg, CALLER);
  return fails(outcome) ? -1 : HELIOGRAPH_NEXT(send)(socket, from, outcome.limit(bytes), flags);
}

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  const Outcome outcome = by_caller(Function::sendmsg, CALLER);
  if (fails(outcome)) return -1;
  iovec first;
  const msghdr shorter = cut(*message, outcome, first);
  return HELIOGRAPH_NEXT(sendmsg)(socket, &shorter, flags);
}

int epoll_wait(int queue, epoll_event* events, int most, int milliseconds) {
  return fails(by_caller(Function::epoll_wait, CALLER))
             ? -1
             : HELIOGRAPH_NEXT(epoll_wait)(queue, events, most, milliseconds);
}

int pipe2(int ends[2], int flags) noexcept {
  return fails(by_caller(Function::pipe2, CALLER)) ? -1 : HELIOGRAPH_NEXT(pipe2)(ends, flags);
}

pid_t fork() noexcept {
  return fails(by_caller(Function::fork, CALLER)) ? -1 : HELIOGRAPH_NEXT(fork)();
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                   void* argument) noexcept {
  const Outcome outcome = by_caller(Function::pthread_create, CALLER);
  return outcome.error != 0 ? outcome.error
                            : HELIOGRAPH_NEXT(pthread_create)(thread, attributes, run, argument);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = HELIOGRAPH_NEXT(clock_gettime)(clock, time);
  if (clock == CLOCK_REALTIME) time->tv_sec += jump();
  return result;
}

int gettimeofday(timeval* time, void* zone) noexcept {
  const int result = HELIOGRAPH_NEXT(gettimeofday)(time, zone);
  time->tv_sec += jump();
  return result;
}

time_t time(time_t* result) noexcept {
  timespec now{};
  HELIOGRAPH_NEXT(clock_gettime)(CLOCK_REALTIME, &now);
  now.tv_sec += jump();
  if (result) *result = now.tv_sec;
  return now.tv_sec;
}

}  // extern "C"
