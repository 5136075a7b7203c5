#include "session/library/scene_cache.hpp"

#include <algorithm>
#include <iterator>

namespace heliograph::session {
namespace {

bool unchanged(const std::vector<scene::SourceFile>& sources) {
  return std::ranges::all_of(sources, [](const scene::SourceFile& source) {
    return scene::examine_file(source.path) == source;
  });
}

}  // namespace

/// The same scene, through pointers that keep the whole entry in use and tell of their end.
LoadedScene SceneCache::shown_copy(const std::shared_ptr<const LoadedScene>& entry) const {
  const std::shared_ptr<const LoadedScene> shown(
      entry.get(), [held = entry, released = released_](const LoadedScene*) mutable {
        held.reset();
        if (released) released->notify();
      });
  LoadedScene scene = *entry;
  scene.scene = {shown, entry->scene.get()};
  scene.resources = {shown, entry->resources.get()};
  return scene;
}

std::optional<LoadedScene> SceneCache::find(const SceneKey& key) {
  Entries dropped;
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(entries_, key, &Entry::key);
  if (found == entries_.end()) return std::nullopt;
  if (!unchanged(found->sources)) {
    drop(found, dropped);
    return std::nullopt;
  }
  entries_.splice(entries_.end(), entries_, found);
  return shown_copy(found->scene);
}

std::optional<SceneCache::Loaded> SceneCache::find_elsewhere(const SceneKey& key) const {
  const std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_) {
    SceneKey here = entry.key;
    here.device = key.device;
    if (here == key && unchanged(entry.sources)) return Loaded{*entry.scene, entry.sources};
  }
  return std::nullopt;
}

LoadedScene SceneCache::add(const SceneKey& key, LoadedScene scene,
                            std::vector<scene::SourceFile> sources) {
  Entries dropped;
  const std::lock_guard lock(mutex_);
  const auto old = std::ranges::find(entries_, key, &Entry::key);
  if (old != entries_.end()) drop(old, dropped);
  totals_.bytes += bytes_of(scene);
  entries_.push_back(
      {key, std::make_shared<const LoadedScene>(std::move(scene)), std::move(sources)});
  return shown_copy(entries_.back().scene);
}

void SceneCache::clear(std::size_t device) {
  Entries dropped;
  const std::lock_guard lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const auto next = std::next(entry);
    if (entry->key.device == device) drop(entry, dropped);
    entry = next;
  }
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
  Entries dropped;
  const std::lock_guard lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const auto next = std::next(entry);
    // No request finds it any more.
    if (!entry->shown() && !unchanged(entry->sources)) drop(entry, dropped);
    entry = next;
  }
  for (auto entry = entries_.begin(); entry != entries_.end() && totals_.bytes > max_bytes_;) {
    const auto next = std::next(entry);
    if (!entry->shown()) {
      drop(entry, dropped);
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

void SceneCache::drop(Entries::iterator entry, Entries& dropped) {
  dropped.splice(dropped.end(), entries_, entry);
  totals_.bytes -= bytes_of(*entry->scene);
}

/// What it takes beside the entries, which may have the scene on other devices.
std::uint64_t SceneCache::bytes_of(const LoadedScene& scene) const {
  const bool shared = std::ranges::any_of(
      entries_, [&](const Entry& entry) { return entry.scene->scene == scene.scene; });
  return scene.device_bytes + (shared ? 0 : scene.host_bytes);
}

}  // namespace heliograph::session
