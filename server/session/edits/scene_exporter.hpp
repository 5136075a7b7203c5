#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "protocol/json/pending_answer.hpp"
#include "protocol/result.hpp"
#include "scene/import_limits.hpp"
#include "session/edits/scene_export.hpp"
#include "session/worker.hpp"

namespace heliograph::session {

/// A file that is removed with this object.
class TemporaryFile {
 public:
  /// Empty, in the folder of temporary files. @throws std::runtime_error
  TemporaryFile();
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct ExportedScene {
  std::shared_ptr<const TemporaryFile> file;
  std::uint64_t bytes = 0;
  std::vector<std::string> warnings;
};

/// Writes edited scenes as .glb files, on a thread of its own, one after another.
class SceneExporter {
 public:
  explicit SceneExporter(scene::ImportLimits limits);

  using Done = std::function<void(protocol::Result<ExportedScene>)>;
  /// `done` is called once, here or on the exporting thread. Nothing is written once `answer`,
  /// which may be null, is abandoned.
  void write(SceneExport scene, std::shared_ptr<const protocol::PendingAnswer> answer, Done done);
  /// Ends the running export; the others stay unanswered.
  void stop();

 private:
  protocol::Result<ExportedScene> write_file(const SceneExport& scene) const;

  const scene::ImportLimits limits_;
  std::stop_source stop_;
  Worker worker_;
};

}  // namespace heliograph::session
