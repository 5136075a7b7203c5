#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scene/import.hpp"
#include "session/library/loaded_scene.hpp"

namespace heliograph::session {

/// What a load is for: two with the same key lead to the same picture.
struct SceneKey {
  std::filesystem::path file;
  scene::SceneChoice choice;
  std::filesystem::path environment;  // empty: none
  bool operator==(const SceneKey&) const = default;
};

/// Since the server started, but for what is kept now.
struct CacheTotals {
  std::uint64_t hits = 0;    // requests that needed no load of their own
  std::uint64_t misses = 0;  // loads that were begun
  std::uint64_t evictions = 0;
  std::uint64_t entries = 0;
  std::uint64_t bytes = 0;
};

/// Scenes on the device, shared by every session that shows them and kept for the next that wants
/// them: within a limit of memory the ones that nobody shows, longest unused out first. What is
/// shown stays, whatever the limit. Thread safe.
class SceneCache {
 public:
  explicit SceneCache(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  /// The scene, if its files are still as they were read.
  std::optional<LoadedScene> find(const SceneKey& key);
  /// Keeps `scene`, read from `sources`, and gives what is to be shown of it: only so the cache
  /// knows whether it still is.
  LoadedScene add(const SceneKey& key, LoadedScene scene, std::vector<scene::SourceFile> sources);
  /// Forgets everything, since the device it was on is gone.
  void clear();
  void count_hit();
  void count_miss();

  /// Drops what nobody shows until the rest is within the limit. False while it is not.
  bool trim();
  CacheTotals totals() const;

 private:
  struct Entry {
    SceneKey key;
    std::shared_ptr<const LoadedScene> scene;
    std::vector<scene::SourceFile> sources;
    bool shown() const { return scene.use_count() > 1; }
  };

  void drop(std::list<Entry>::iterator entry);

  const std::uint64_t most_bytes_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  // longest unused first
  CacheTotals totals_;
};

}  // namespace heliograph::session
