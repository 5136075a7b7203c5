#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "gpu/pipelines/shader_binary.hpp"

namespace heliograph::gpu {

class Program;

/// The programs of a device, and the shader stages that replace embedded ones: those that were
/// compiled from source files at run time. All functions but `lock` and `remove` need the lock,
/// which the constructors of programs hold too, so that none is made of words that are just being
/// replaced.
class ProgramRegistry {
 public:
  using Lock = std::unique_lock<std::mutex>;
  Lock lock() const { return Lock(mutex_); }

  void add(Program& program) { programs_.insert(&program); }
  void remove(Program& program);
  const std::set<Program*>& programs() const { return programs_; }

  /// `embedded`, or the stage of the same name that replaces it; valid while the lock is held.
  ShaderBinary current(const ShaderBinary& embedded) const;
  void replace(const std::string& name, std::vector<std::uint32_t> words);

 private:
  mutable std::mutex mutex_;
  std::set<Program*> programs_;
  std::map<std::string, std::vector<std::uint32_t>, std::less<>> replaced_;
};

/// A program in the registry of its device. The last member of a class, so that a program leaves
/// the registry before anything of it ends.
class RegisteredProgram {
 public:
  RegisteredProgram() = default;
  /// The registry's lock is held.
  void enter(ProgramRegistry& registry, Program& program);
  ~RegisteredProgram();
  RegisteredProgram(const RegisteredProgram&) = delete;
  RegisteredProgram& operator=(const RegisteredProgram&) = delete;

 private:
  ProgramRegistry* registry_ = nullptr;
  Program* program_ = nullptr;
};

}  // namespace heliograph::gpu
