#pragma once

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace heliograph::bench {

/// A server that runs as users run it; ended with this.
class ServerProcess {
 public:
  /// Starts `program serve` with these arguments on a free port, and waits for its first frame.
  /// @throws std::runtime_error
  ServerProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  std::uint16_t port() const { return port_; }
  /// That its threads have used so far.
  double cpu_seconds() const;

 private:
  void end();

  using Pipe = std::unique_ptr<FILE, int (*)(FILE*)>;

  pid_t process_ = 0;
  Pipe output_{nullptr, fclose};  // what it prints must not fail
  std::uint16_t port_ = 0;
};

}  // namespace heliograph::bench
