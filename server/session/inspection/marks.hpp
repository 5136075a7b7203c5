#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/result.hpp"
#include "session/inspection/scene_part.hpp"

namespace heliograph::session {

/// How errors call marks of a kind, and how many a session may have.
struct MarkKind {
  std::string_view article;  // "an"
  std::string_view name;     // "annotation"
  std::size_t most;          // of all scenes
};

/// What viewers have added to the scenes of a session, of one kind, in the order of ids. An `Entry`
/// has its ScenePart `part` and its `id`. A refused change changes nothing. Copies share their
/// entries. Not thread safe.
template <class Entry>
class Marks {
 public:
  explicit Marks(const MarkKind& kind) : kind_(kind) {}

  const std::vector<Entry>& entries() const { return *entries_; }
  /// How often they have been changed.
  std::uint32_t changes() const { return changes_; }
  /// The id of one that is added without.
  std::uint32_t next_id() const { return last_id_ + 1; }

  protocol::Result<void> add(Entry entry) {
    const std::string name(kind_.name);
    Entries entries = *entries_;
    const auto place = std::ranges::lower_bound(entries, entry.id, {}, &Entry::id);
    if (place != entries.end() && place->id == entry.id) {
      return protocol::error::conflict("id", "there is " + std::string(kind_.article) + " " + name +
                                                 " " + std::to_string(entry.id));
    }
    if (entries.size() >= kind_.most) {
      return protocol::error::full("the session has no room for more " + name + "s: remove one",
                                   std::to_string(kind_.most) + " of all scenes");
    }
    last_id_ = std::max(last_id_, entry.id);
    entries.insert(place, std::move(entry));
    replace(std::move(entries));
    return {};
  }

  /// Changes one by `edit(entry)`.
  template <class Edit>
  protocol::Result<void> edit(const ScenePart& part, std::uint32_t id, const Edit& edit) {
    Entries entries = *entries_;
    const auto found = std::ranges::find(entries, id, &Entry::id);
    if (found == entries.end() || found->part != part) return unknown(id);
    edit(*found);
    replace(std::move(entries));
    return {};
  }

  protocol::Result<void> remove(const ScenePart& part, std::uint32_t id) {
    Entries entries = *entries_;
    const auto removed = std::erase_if(
        entries, [&](const Entry& entry) { return entry.part == part && entry.id == id; });
    if (removed == 0) return unknown(id);
    replace(std::move(entries));
    return {};
  }

  void clear(const ScenePart& part) {
    Entries entries = *entries_;
    std::erase_if(entries, [&](const Entry& entry) { return entry.part == part; });
    replace(std::move(entries));
  }

  /// Counts a change of what belongs to them all.
  void changed() { ++changes_; }

 private:
  using Entries = std::vector<Entry>;

  protocol::Error unknown(std::uint32_t id) const {
    return protocol::error::not_found(
        "id", "the scene has no " + std::string(kind_.name) + " " + std::to_string(id));
  }

  void replace(Entries entries) {
    entries_ = std::make_shared<const Entries>(std::move(entries));
    changed();
  }

  MarkKind kind_;
  std::shared_ptr<const Entries> entries_ = std::make_shared<const Entries>();
  std::uint32_t last_id_ = 0;
  std::uint32_t changes_ = 0;
};

}  // namespace heliograph::session
