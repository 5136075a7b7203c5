#include "gpu/pipelines/shader_compiler.hpp"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

namespace heliograph::gpu {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, EShLanguage>, 7> stage_kinds{
    {{".comp", EShLangCompute},
     {".vert", EShLangVertex},
     {".frag", EShLangFragment},
     {".rgen", EShLangRayGen},
     {".rmiss", EShLangMiss},
     {".rchit", EShLangClosestHit},
     {".rahit", EShLangAnyHit}}};

std::optional<EShLanguage> stage_kind(const fs::path& file) {
  const auto kind = std::find_if(stage_kinds.begin(), stage_kinds.end(),
                                 [&](const auto& k) { return file.extension() == k.first; });
  return kind == stage_kinds.end() ? std::nullopt : std::optional(kind->second);
}

std::optional<std::string> read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

/// Finds included files and keeps their names and texts.
class Includer : public glslang::TShader::Includer {
 public:
  explicit Includer(const fs::path& folder) : folder_(folder) {}

  std::set<fs::path> files;

  IncludeResult* includeLocal(const char* name, const char* including, std::size_t) override {
    // Files are known to the compiler by their path from the folder's parent.
    return find(
        name, {(folder_.parent_path() / including).parent_path(), folder_.parent_path(), folder_});
  }
  IncludeResult* includeSystem(const char* name, const char*, std::size_t) override {
    return find(name, {folder_.parent_path(), folder_});
  }
  void releaseInclude(IncludeResult* result) override {
    if (!result) return;
    delete static_cast<std::string*>(result->userData);
    delete result;
  }

 private:
  IncludeResult* find(const fs::path& name, std::initializer_list<fs::path> folders) {
    for (const fs::path& folder : folders) {
      const fs::path file = (folder / name).lexically_normal();
      auto text = read_text(file);
      if (!text) continue;
      files.insert(file);
      auto kept = std::make_unique<std::string>(std::move(*text));
      const fs::path shown = file.lexically_relative(folder_.parent_path());
      auto* result = new IncludeResult(shown.string(), kept->data(), kept->size(), kept.get());
      kept.release();
      return result;
    }
    return nullptr;
  }

  const fs::path& folder_;
};

/// Lines of the compiler's log without its prefixes and its closing count of errors.
std::string tidy(const std::string& log) {
  constexpr std::string_view prefix = "ERROR: ";
  std::istringstream lines(log);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(prefix) || line.ends_with("No code generated.")) continue;
    result += (result.empty() ? "" : "\n") + line.substr(prefix.size());
  }
  return result.empty() ? log : result;
}

void initialize_once() {
  static const bool initialized = glslang::InitializeProcess();
  static_cast<void>(initialized);
}

}  // namespace

ShaderCompiler::ShaderCompiler(const fs::path& folder)
    : folder_(fs::absolute(folder / "").lexically_normal().parent_path()) {
  initialize_once();
}

std::vector<fs::path> ShaderCompiler::stages() const {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file() && stage_kind(entry.path())) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

CompiledShader ShaderCompiler::compile(const fs::path& stage) const {
  const std::string name = stage.lexically_relative(folder_.parent_path()).string();
  Includer includer(folder_);
  includer.files.insert(stage);
  const auto fail = [&](const std::string& text) { throw ShaderError(text, includer.files); };
  const auto kind = stage_kind(stage);
  const auto text = read_text(stage);
  if (!kind || !text) fail(name + ": cannot be read");

  glslang::TShader shader(*kind);
  const char* const source = text->c_str();
  const char* const source_name = name.c_str();
  const int length = static_cast<int>(text->size());
  shader.setStringsWithLengthsAndNames(&source, &length, &source_name, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, *kind, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  const auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  constexpr int version_without_directive = 100;
  if (!shader.parse(GetDefaultResources(), version_without_directive, false, messages, includer)) {
    fail(tidy(shader.getInfoLog()));
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages) || !program.mapIO()) fail(name + ": " + tidy(program.getInfoLog()));

  CompiledShader result;
  glslang::SpvOptions options;
  options.disableOptimizer = true;
  spv::SpvBuildLogger logger;
  glslang::GlslangToSpv(*program.getIntermediate(*kind), result.words, &logger, &options);
  result.files = std::move(includer.files);
  return result;
}

}  // namespace heliograph::gpu
