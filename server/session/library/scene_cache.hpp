#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/import.hpp"
#include "session/library/loaded_scene.hpp"
#include "session/wake_event.hpp"

namespace heliograph::session {

/// Identifies a load: the same key gives the same scene on the same device.
struct SceneKey {
  std::filesystem::path file;
  scene::SceneChoice choice;
  std::filesystem::path environment;  // empty: none
  std::size_t device = 0;
  std::vector<scene::TextureOverride> textures = {};  // sorted: see session/edits/texture_edits.hpp
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

/// Least recently used cache of scenes on devices, shared by all sessions that show them. Within
/// a memory limit it keeps scenes that no session shows; shown ones stay whatever the limit. Calls
/// that drop scenes free them before they return, without the lock. Thread safe.
class SceneCache {
 public:
  /// `released`, if any, is notified when a scene is not shown any more.
  explicit SceneCache(std::uint64_t max_bytes, std::shared_ptr<WakeEvent> released = nullptr)
      : max_bytes_(max_bytes), released_(std::move(released)) {}

  /// The scene, if its files have not changed.
  std::optional<LoadedScene> find(const SceneKey& key);
  /// A scene and the files that it was loaded from.
  struct Loaded {
    LoadedScene scene;
    std::vector<scene::SourceFile> sources;
  };
  /// The same scene on another device, if its files have not changed. It does not count as shown.
  std::optional<Loaded> find_elsewhere(const SceneKey& key) const;
  /// Stores `scene`, loaded from `sources`, and gives the object to show, whose references tell the
  /// cache that it is shown.
  LoadedScene add(const SceneKey& key, LoadedScene scene, std::vector<scene::SourceFile> sources);
  /// Drops everything on a device, since it was lost.
  void clear(std::size_t device);
  void count_hit();
  void count_miss();

  /// Drops scenes that are not shown: those whose files have changed or are gone, and others until
  /// the rest is within the limit. False if it is not.
  bool trim();
  CacheTotals totals() const;

 private:
  struct Entry {
    SceneKey key;
    std::shared_ptr<const LoadedScene> scene;
    std::vector<scene::SourceFile> sources;
    bool shown() const { return scene.use_count() > 1; }
  };

  using Entries = std::list<Entry>;

  LoadedScene shown_copy(const std::shared_ptr<const LoadedScene>& entry) const;
  /// Moves an entry to `dropped`, which callers declare before their lock: it is freed after that.
  void drop(Entries::iterator entry, Entries& dropped);
  std::uint64_t bytes_of(const LoadedScene& scene) const;

  const std::uint64_t max_bytes_;
  const std::shared_ptr<WakeEvent> released_;
  mutable std::mutex mutex_;
  Entries entries_;  // least recently used first
  CacheTotals totals_;
};

}  // namespace heliograph::session
