#include "session/edits/scene_exporter.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "scene/gltf/export/glb_export.hpp"
#include "session/event_log.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

constexpr std::size_t max_queued_exports = 8;

}  // namespace

TemporaryFile::TemporaryFile() {
  std::string pattern = std::filesystem::temp_directory_path() / "heliograph-scene-XXXXXX";
  const int descriptor = mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor < 0) throw std::runtime_error("a temporary file cannot be made");
  ::close(descriptor);
  path_ = pattern;
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

SceneExporter::SceneExporter(scene::ImportLimits limits)
    : limits_(std::move(limits)), worker_("scene exporter", max_queued_exports) {}

void SceneExporter::stop() {
  stop_.request_stop();
  worker_.stop();
}

void SceneExporter::write(SceneExport scene, std::shared_ptr<const protocol::PendingAnswer> answer,
                          Done done) {
  const bool taken =
      worker_.post([this, scene = std::move(scene), answer = std::move(answer), done] {
        if (answer && answer->abandoned()) {
          return done(error::conflict("scene", "the client has gone"));
        }
        done(write_file(scene));
      });
  if (!taken) {
    done(error::full("too many scenes wait to be exported", std::to_string(max_queued_exports)));
  }
}

Result<ExportedScene> SceneExporter::write_file(const SceneExport& scene) const {
  try {
    ExportedScene exported{
        .file = std::make_shared<const TemporaryFile>(), .bytes = 0, .warnings = scene.warnings};
    std::ofstream out(exported.file->path(), std::ios::binary);
    const std::vector<std::string> more =
        scene::export_glb(*scene.scene, scene.changes, limits_, out, stop_.get_token());
    exported.warnings.insert(exported.warnings.end(), more.begin(), more.end());
    out.close();
    if (!out) throw std::runtime_error("the disk is full or has failed");
    exported.bytes = std::filesystem::file_size(exported.file->path());
    return exported;
  } catch (const scene::ImportError& why) {
    return error::conflict("scene", std::string("cannot be exported: ") + why.what());
  } catch (const scene::LoadCancelled&) {
    return error::not_ready("the server is shutting down");
  } catch (const std::runtime_error& failure) {
    log_error({}, std::string("an exported scene could not be written: ") + failure.what());
    return error::full("the server's disk is full or has failed");
  }
}

}  // namespace heliograph::session
