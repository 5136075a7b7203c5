#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "protocol/messages/kinds.hpp"
#include "protocol/result.hpp"
#include "session/library/import_process.hpp"
#include "session/library/scene_catalogue.hpp"
#include "session/worker.hpp"

namespace heliograph::session {

struct UploadOptions {
  std::filesystem::path folder;
  std::uint64_t max_bytes = 256ull << 20;     // of one file
  std::uint64_t quota = 4ull << 30;           // of all files together
  std::vector<std::string> import_arguments;  // see ImportProcess
};

using protocol::UploadKind;

struct UploadedFile {
  UploadKind kind = UploadKind::scene;
  std::string name;
  std::uint64_t bytes = 0;
  std::uint64_t triangles = 0;  // of a scene
  std::uint32_t width = 0;      // of an environment or image, in pixels
  std::uint32_t height = 0;
};

/// Scenes, environments and images of textures that clients upload. Each is checked by importing
/// it, in a process of its own, and then moved atomically to where the catalogue finds it. Thread
/// safe.
class UploadStore {
 public:
  /// Creates the folders and removes unfinished uploads of an earlier process.
  /// @throws std::runtime_error when that fails
  explicit UploadStore(UploadOptions options);

  /// Folder of accepted scenes: a root for the catalogue.
  const std::filesystem::path& scenes() const { return scenes_; }
  /// Folder of accepted environments, apart from the scenes so that none becomes the sky of a scene
  /// by its name.
  const std::filesystem::path& environments() const { return environments_; }
  /// Folder of accepted images of textures.
  const std::filesystem::path& images() const { return images_; }
  std::uint64_t max_bytes() const { return options_.max_bytes; }

  /// A file that is being received. The destructor releases its reserved bytes and removes the file
  /// if it was not accepted.
  class Incoming;
  /// Starts an upload of this name and size; its bytes go to `path()`.
  protocol::Result<std::shared_ptr<Incoming>> begin(UploadKind kind, const std::string& name,
                                                    std::uint64_t bytes);
  /// Checks the received file on a thread of its own and moves it into place. When `done` is called
  /// nothing of the upload is left but the accepted scene.
  void finish(std::shared_ptr<Incoming> incoming,
              std::function<void(protocol::Result<UploadedFile>)> done);
  /// Deletes an accepted file: its bytes count no longer. Who has it open still reads it. An upload
  /// of this name that is being received or checked is accepted afterwards.
  /// Error invalid: there are no such names; not_found: no upload has this name.
  protocol::Result<void> remove(UploadKind kind, const std::string& name);
  /// Ends the thread and the import that runs; `done` is not called any more.
  void stop();

 private:
  protocol::Result<UploadedFile> accept(Incoming& incoming);
  void accept_scene(Incoming& incoming, UploadedFile& accepted);
  void accept_environment(Incoming& incoming, UploadedFile& accepted);
  void accept_image(Incoming& incoming, UploadedFile& accepted);
  const std::filesystem::path& folder_of(UploadKind kind) const;
  std::uint64_t bytes_kept() const;

  const UploadOptions options_;
  std::filesystem::path scenes_;
  std::filesystem::path environments_;
  std::filesystem::path images_;
  std::filesystem::path incoming_;
  std::mutex mutex_;
  std::uint64_t reserved_bytes_ = 0;  // for files that are being received
  std::uint64_t upload_count_ = 0;
  ImportProcess importer_;
  Worker checker_;
};

/// Whether a file that a catalogue found in the store's folder of its kind is one that
/// `UploadStore::remove` deletes: none that was put there in other ways, such as one in a folder of
/// its own.
bool is_upload(const CatalogueEntry& entry);

class UploadStore::Incoming {
 public:
  Incoming(UploadStore& store, UploadKind kind, std::string name, std::uint64_t bytes,
           std::filesystem::path folder);
  ~Incoming();
  Incoming(const Incoming&) = delete;
  Incoming& operator=(const Incoming&) = delete;

  UploadKind kind() const { return kind_; }
  const std::string& name() const { return name_; }
  std::filesystem::path path() const {
    return folder_ / (name_ + (kind_ == UploadKind::scene ? ".glb" : ""));
  }
  /// Moves the file to its final place and releases its reserved bytes, atomically. @throws
  /// std::filesystem::filesystem_error
  void keep_as(const std::filesystem::path& file);

 private:
  UploadStore& store_;
  const UploadKind kind_;
  const std::string name_;
  std::uint64_t bytes_;  // reserved
  const std::filesystem::path folder_;
};

}  // namespace heliograph::session
