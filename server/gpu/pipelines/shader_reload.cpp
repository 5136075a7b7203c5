#include "gpu/pipelines/shader_reload.hpp"

#include <algorithm>
#include <future>
#include <set>
#include <utility>

#include "gpu/pipelines/shader.hpp"

namespace heliograph::gpu {
namespace {

namespace fs = std::filesystem;

/// Adds the lines of `text` that are not there yet: many stages meet the error of one included
/// file.
void add_lines(std::string& all, std::set<std::string>& lines, const std::string& text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    if (lines.insert(line).second) all += (all.empty() ? "" : "\n") + line;
    begin = end + 1;
  }
}

}  // namespace

ShaderReload::ShaderReload(const Device& device, const fs::path& folder,
                           std::span<const ShaderBinary* const> embedded)
    : device_(device), compiler_(folder), watch_(compiler_.folder()) {
  for (const ShaderBinary* shader : embedded) {
    Stage& stage = stages_[std::string(shader->name)];
    stage.embedded = shader;
    newest_[std::string(shader->name)].assign(shader->words.begin(), shader->words.end());
  }
  check_files();
  apply();
  thread_ = std::thread([this] {
    while (watch_.wait()) check_files();
  });
}

ShaderReload::~ShaderReload() {
  watch_.stop();
  thread_.join();
}

void ShaderReload::listen(Listener listener) {
  const std::lock_guard lock(mutex_);
  listener_ = std::move(listener);
  if (listener_ && !error_.empty()) listener_({.error = error_, .reloaded = {}});
}

std::string ShaderReload::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void ShaderReload::check_files() {
  const Stamps now = read_stamps();
  if (now == stamps_) return;
  std::vector<std::future<void>> compiling;
  for (Stage* stage : stages_to_compile(now)) {
    compiling.push_back(std::async(std::launch::async, [this, stage] { compile(*stage); }));
    if (compiling.size() == std::max(std::thread::hardware_concurrency(), 1u)) compiling.clear();
  }
  compiling.clear();  // waits
  stamps_ = now;
  publish(prepare());
}

ShaderReload::Stamps ShaderReload::read_stamps() const {
  Stamps stamps;
  std::error_code error;  // a file may vanish between listing and looking: editors do that
  for (fs::recursive_directory_iterator entry(compiler_.folder(), error), end; entry != end;
       entry.increment(error)) {
    if (!entry->is_regular_file(error)) continue;
    const Stamp stamp{entry->last_write_time(error), entry->file_size(error)};
    if (!error) stamps[entry->path()] = stamp;
  }
  return stamps;
}

std::vector<ShaderReload::Stage*> ShaderReload::stages_to_compile(const Stamps& now) {
  for (const auto& [file, stamp] : now) {
    const auto stage = stages_.find(file.filename().string());
    if (stage != stages_.end()) stage->second.file = file;
  }
  const auto changed = [&](const fs::path& file) {
    const auto before = stamps_.find(file);
    const auto after = now.find(file);
    if (before == stamps_.end() || after == now.end()) return true;
    return !(before->second == after->second);
  };
  std::vector<Stage*> result;
  for (auto& [name, stage] : stages_) {
    if (stage.file.empty()) continue;  // the folder has no such stage: the embedded one stays
    const auto& files = stage.compiled.files;
    if (files.empty() || !stage.error.empty() || std::any_of(files.begin(), files.end(), changed)) {
      result.push_back(&stage);
    }
  }
  return result;
}

void ShaderReload::compile(Stage& stage) const {
  try {
    stage.compiled = compiler_.compile(stage.file);
    stage.error.clear();
    const ShaderBinary binary{stage.embedded->name, stage.compiled.words};
    const std::string difference = interface_difference(reflect(*stage.embedded), reflect(binary));
    if (difference.empty()) return;
    stage.error = stage.file.lexically_relative(compiler_.folder().parent_path()).string() +
                  ":1: " + difference +
                  " differs from what the server was built with: build it again";
  } catch (const ShaderError& failure) {
    stage.error = failure.what();
    stage.compiled.files = failure.files;
  } catch (const std::exception& failure) {
    stage.error = std::string(stage.embedded->name) + ": " + failure.what();
  }
}

/// Prepares every program for what has been compiled, or none.
ShaderReport ShaderReload::prepare() {
  ShaderReport report;
  std::set<std::string> lines;
  Words changed;
  for (const auto& [name, stage] : stages_) {
    add_lines(report.error, lines, stage.error);
    const auto& words = stage.compiled.words;
    if (!words.empty() && words != newest_.at(name)) changed[name] = words;
  }
  if (!report.error.empty() || changed.empty()) return report;
  try {
    prepare_programs(changed);
  } catch (const GpuError& failure) {
    report.error = failure.what();
    return report;
  }
  for (auto& [name, words] : changed) {
    newest_[name] = std::move(words);
    report.reloaded.push_back(name);
  }
  return report;
}

void ShaderReload::prepare_programs(const Words& changed) {
  const ProgramRegistry::Lock lock = device_.programs().lock();
  Words all = prepared_;  // also what no frame has asked for yet
  for (const auto& [name, words] : changed) all[name] = words;
  const auto newest = [&](const ShaderBinary& embedded) {
    const auto words = all.find(std::string(embedded.name));
    return words == all.end() ? device_.programs().current(embedded)
                              : ShaderBinary{embedded.name, words->second};
  };
  const auto affected = [&](const ShaderBinary& stage) {
    return changed.contains(std::string(stage.name));
  };
  std::vector<std::pair<Program*, VkPipeline>> made;
  try {
    for (Program* program : device_.programs().programs()) {
      const auto& embedded = program->embedded_stages();
      if (std::none_of(embedded.begin(), embedded.end(), affected)) continue;
      std::vector<ShaderBinary> stages;
      std::transform(embedded.begin(), embedded.end(), std::back_inserter(stages), newest);
      made.emplace_back(program, program->make_pipeline(stages));
    }
  } catch (...) {
    for (const auto& [program, pipeline] : made) {
      vkDestroyPipeline(device_.handle(), pipeline, nullptr);
    }
    throw;
  }
  for (const auto& [program, pipeline] : made) program->prepare(pipeline);
  prepared_ = std::move(all);
  has_prepared_ = true;
}

void ShaderReload::publish(const ShaderReport& report) {
  Listener listener;
  {
    const std::lock_guard lock(mutex_);
    error_ = report.error;
    listener = listener_;
  }
  ++version_;
  if (listener) listener(report);
}

void ShaderReload::apply() {
  if (!has_prepared_) return;
  ProgramRegistry& registry = device_.programs();
  const ProgramRegistry::Lock lock = registry.lock();
  for (auto& [name, words] : prepared_) registry.replace(name, std::move(words));
  for (Program* program : registry.programs()) {
    const auto& embedded = program->embedded_stages();
    const bool affected = std::any_of(embedded.begin(), embedded.end(), [&](const auto& stage) {
      return prepared_.contains(std::string(stage.name));
    });
    if (affected) program->use_newest();
  }
  prepared_.clear();
  has_prepared_ = false;
  ++program_version_;
}

}  // namespace heliograph::gpu
