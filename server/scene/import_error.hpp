#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace heliograph::scene {

/// Why a file was rejected: one line that names the glTF object and the reason, and reveals nothing
/// about files outside the scene's folder.
class ImportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that another one refers to does not exist.
class MissingFile : public ImportError {
 public:
  using ImportError::ImportError;
};

/// The file has no such scene or variant.
class NoSuchChoice : public ImportError {
 public:
  /// `member` of SceneChoice; `names`: the available ones.
  NoSuchChoice(std::string member, const std::string& requested, std::vector<std::string> names);

  const std::string& member() const { return member_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::string member_;
  std::vector<std::string> names_;
};

}  // namespace heliograph::scene
