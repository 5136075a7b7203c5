#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace heliograph::gpu {

/// What a compiler said of a shader, a line per error: "shaders/lib/a.glsl:12: 'x' : undeclared".
class ShaderError : public std::runtime_error {
 public:
  ShaderError(const std::string& text, std::set<std::filesystem::path> read_files)
      : std::runtime_error(text), files(std::move(read_files)) {}
  std::set<std::filesystem::path> files;  // that were read until then
};

struct CompiledShader {
  std::vector<std::uint32_t> words;       // SPIR-V 1.6
  std::set<std::filesystem::path> files;  // the stage's own and all that it includes
};

/// Compiles the stages of a folder as the build does (shaders/CMakeLists.txt): GLSL for Vulkan 1.3,
/// includes are searched beside the including file, in the folder's parent and in the folder.
class ShaderCompiler {
 public:
  explicit ShaderCompiler(const std::filesystem::path& folder);

  /// `stage` is a file below the folder; its extension names the kind of stage. Thread safe.
  /// @throws ShaderError
  CompiledShader compile(const std::filesystem::path& stage) const;
  /// All stages below the folder, by file name, which is unique there.
  std::vector<std::filesystem::path> stages() const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;  // absolute
};

}  // namespace heliograph::gpu
