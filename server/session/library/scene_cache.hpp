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

/// Identifies a load: the same key gives the same scene.
struct SceneKey {
  std::filesystem::path file;
  scene::SceneChoice choice;
  std::filesystem::path environment;  // empty: none
  bool operator==(const SceneKey&) const = default;
};

/// Since the server started; `entries` and `bytes` at present.
struct CacheTotals {
  std::uint64_t hits = 0;    // requests without a load of their own
  std::uint64_t misses = 0;  // loads that were started
  std::uint64_t evictions = 0;
  std::uint64_t entries = 0;
  std::uint64_t bytes = 0;
};

/// Least recently used cache of scenes on the device, shared by all sessions that show them. Within
/// a memory limit it keeps scenes that no session shows; shown ones stay whatever the limit. Thread
/// safe.
class SceneCache {
 public:
  explicit SceneCache(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  /// The scene, if its files have not changed.
  std::optional<LoadedScene> find(const SceneKey& key);
  /// Stores `scene`, loaded from `sources`, and gives the object to show, whose references tell the
  /// cache that it is shown.
  LoadedScene add(const SceneKey& key, LoadedScene scene, std::vector<scene::SourceFile> sources);
  /// Drops everything, since the device was lost.
  void clear();
  void count_hit();
  void count_miss();

  /// Drops scenes that are not shown until the rest is within the limit. False if it is not.
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

  const std::uint64_t max_bytes_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  // least recently used first
  CacheTotals totals_;
};

}  // namespace heliograph::session
