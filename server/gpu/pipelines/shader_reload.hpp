#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "gpu/device/device.hpp"
#include "gpu/pipelines/folder_watch.hpp"
#include "gpu/pipelines/shader_binary.hpp"
#include "gpu/pipelines/shader_compiler.hpp"
#include "gpu/pipelines/shader_report.hpp"

namespace heliograph::gpu {

/// Shaders from source files in place of the embedded ones of the same name. A thread compiles them
/// whenever they or files that they include are saved; programs take them over when `apply` is
/// called, all or none. What a shader binds, its push constants and its workgroup size stay as they
/// are in the embedded one: they are written down in C++ as well.
class ShaderReload {
 public:
  using Listener = std::function<void(const ShaderReport&)>;

  /// Compiles everything before it returns; errors are told by `error`. `device` and `embedded`
  /// outlive this; made before the device's programs, so that these start with the files' code.
  ShaderReload(const Device& device, const std::filesystem::path& folder,
               std::span<const ShaderBinary* const> embedded);
  ~ShaderReload();
  ShaderReload(const ShaderReload&) = delete;
  ShaderReload& operator=(const ShaderReload&) = delete;

  /// Called on the compiling thread after every look at changed files.
  void listen(Listener listener);

  /// Lets programs take over what has been compiled: between frames, on the thread that records
  /// them. Costs nothing where nothing has.
  void apply();

  /// Grows whenever `apply` has changed programs.
  std::uint64_t program_version() const { return program_version_; }
  /// Grows whenever there is something to apply or another `error`.
  std::uint64_t version() const { return version_; }
  /// Why the newest files are not in use, a line per error; empty: they are.
  std::string error() const;

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size;
    bool operator==(const Stamp&) const = default;
  };
  using Stamps = std::map<std::filesystem::path, Stamp>;
  struct Stage {
    const ShaderBinary* embedded = nullptr;
    std::filesystem::path file;
    CompiledShader compiled;
    std::string error;
  };
  using Words = std::map<std::string, std::vector<std::uint32_t>>;

  void check_files();
  Stamps read_stamps() const;
  std::vector<Stage*> stages_to_compile(const Stamps& now);
  void compile(Stage& stage) const;
  ShaderReport prepare();
  void prepare_programs(const Words& changed);
  void publish(const ShaderReport& report);

  const Device& device_;
  const ShaderCompiler compiler_;
  FolderWatch watch_;

  // Of the compiling thread.
  Stamps stamps_;
  std::map<std::string, Stage> stages_;
  Words newest_;  // of all that programs have or are prepared for

  // Guarded by the lock of the device's program registry.
  Words prepared_;

  std::atomic<bool> has_prepared_ = false;
  std::atomic<std::uint64_t> program_version_ = 0;
  std::atomic<std::uint64_t> version_ = 0;

  mutable std::mutex mutex_;  // guards what follows
  std::string error_;
  Listener listener_;

  std::thread thread_;
};

}  // namespace heliograph::gpu
