#include "session/library/scene_cache.hpp"

#include <algorithm>

namespace heliograph::session {
namespace {

std::uint64_t bytes_of(const LoadedScene& scene) {
  return scene.host_bytes + scene.device_bytes;
}

bool unchanged(const std::vector<scene::SourceFile>& sources) {
  return std::ranges::all_of(sources, [](const scene::SourceFile& source) {
    return scene::examine_file(source.path) == source;
  });
}

/// The same scene, through pointers that keep the whole entry in use.
LoadedScene shared_copy(const std::shared_ptr<const LoadedScene>& entry) {
  LoadedScene scene = *entry;
  scene.scene = {entry, entry->scene.get()};
  scene.resources = {entry, entry->resources.get()};
  return scene;
}

}  // namespace

std::optional<LoadedScene> SceneCache::find(const SceneKey& key) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(entries_, key, &Entry::key);
  if (found == entries_.end()) return std::nullopt;
  if (!unchanged(found->sources)) {
    drop(found);
    return std::nullopt;
  }
  entries_.splice(entries_.end(), entries_, found);
  return shared_copy(found->scene);
}

LoadedScene SceneCache::add(const SceneKey& key, LoadedScene scene,
                            std::vector<scene::SourceFile> sources) {
  const std::lock_guard lock(mutex_);
  const auto old = std::ranges::find(entries_, key, &Entry::key);
  if (old != entries_.end()) drop(old);
  totals_.bytes += bytes_of(scene);
  entries_.push_back(
      {key, std::make_shared<const LoadedScene>(std::move(scene)), std::move(sources)});
  return shared_copy(entries_.back().scene);
}

void SceneCache::clear() {
  const std::lock_guard lock(mutex_);
  while (!entries_.empty()) drop(entries_.begin());
}

void SceneCache::count_hit() {
  const std::lock_guard lock(mutex_);
  ++totals_.hits;
}

void SceneCache::count_miss() {
  const std::lock_guard lock(mutex_);
  ++totals_.misses;
}

bool SceneCache::trim() {
  const std::lock_guard lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end() && totals_.bytes > max_bytes_;) {
    const auto next = std::next(entry);
    if (!entry->shown()) {
      drop(entry);
      ++totals_.evictions;
    }
    entry = next;
  }
  return totals_.bytes <= max_bytes_;
}

CacheTotals SceneCache::totals() const {
  const std::lock_guard lock(mutex_);
  CacheTotals totals = totals_;
  totals.entries = entries_.size();
  return totals;
}

void SceneCache::drop(std::list<Entry>::iterator entry) {
  totals_.bytes -= bytes_of(*entry->scene);
  entries_.erase(entry);
}

}  // namespace heliograph::session
