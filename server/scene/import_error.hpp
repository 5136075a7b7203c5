#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace heliograph::scene {

/// Why a file was refused: one line that names the object and the reason, never a path or a size
/// of anything outside the scene.
class ImportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The file has no such scene or variant.
class NoSuchChoice : public ImportError {
 public:
  /// `member` of SceneChoice; `names` are those there are.
  NoSuchChoice(std::string member, const std::string& wanted, std::vector<std::string> names);

  const std::string& member() const { return member_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::string member_;
  std::vector<std::string> names_;
};

}  // namespace heliograph::scene
