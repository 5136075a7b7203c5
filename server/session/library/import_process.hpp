#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "session/library/import_helper.hpp"

namespace heliograph::session {

/// What is told of an imported file.
struct ImportedFile {
  std::uint64_t triangles = 0;  // of a scene
  std::uint32_t width = 0;      // of an environment or image, in pixels
  std::uint32_t height = 0;
};

/// Imports files of strangers in processes of their own, which have no rights but to read that one
/// file, and a limit on memory and time: a fault in a decoder costs the answer. They are made by a
/// helper that has nothing of this process in its memory, and that is small, so that making one
/// takes a millisecond.
class ImportProcess {
 public:
  /// `arguments` of this program that make it such a helper; it is started when it is needed.
  explicit ImportProcess(std::vector<std::string> arguments);
  ~ImportProcess() {
    stop();
    end_helper();
  }
  ImportProcess(const ImportProcess&) = delete;
  ImportProcess& operator=(const ImportProcess&) = delete;

  /// `name` stands for the file in errors. One thread at a time.
  /// @throws scene::ImportError for a file that cannot be imported; std::system_error,
  /// std::runtime_error where the process cannot be made
  ImportedFile import(ImportKind kind, const std::string& name, const std::filesystem::path& file);
  /// Ends the import that runs, on any thread; later ones fail.
  void stop();

 private:
  int helper();
  void start();
  void end_helper();
  ImportedFile answer_of(const std::string& text, const ImportEnd& end);

  const std::vector<std::string> arguments_;
  bool warned_ = false;  // of the importing thread
  std::mutex mutex_;     // guards what follows
  bool stopping_ = false;
  pid_t process_ = -1;
  int socket_ = -1;
};

}  // namespace heliograph::session
