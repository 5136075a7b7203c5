#pragma once

#include <cstddef>
#include <stdexcept>
#include <stop_token>
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

/// The file has no such material for a TextureOverride, or its slot is unknown.
class NoSuchSlot : public ImportError {
 public:
  /// `number` of the override; `member` of it; `names`: the available ones.
  NoSuchSlot(std::size_t number, std::string member, std::string requested,
             std::vector<std::string> names);

  std::size_t number() const { return number_; }
  const std::string& member() const { return member_; }
  const std::string& requested() const { return requested_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::size_t number_;
  std::string member_;
  std::string requested_;
  std::vector<std::string> names_;
};

/// Thrown by a load that was asked to stop; not an error.
struct LoadCancelled {};

inline void throw_if_cancelled(const std::stop_token& stop) {
  if (stop.stop_requested()) throw LoadCancelled();
}

/// In a loop over many small things, with the number of each: asks now and then only.
inline void throw_if_cancelled(const std::stop_token& stop, std::size_t number) {
  if (number % 4096 == 0) throw_if_cancelled(stop);
}

}  // namespace heliograph::scene
