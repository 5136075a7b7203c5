#pragma once

#include <string>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "protocol/result.hpp"

namespace heliograph::session {

/// The bookmarks of a session, by scene. A refused request changes nothing. Not thread safe.
class Bookmarks {
 public:
  /// In the order in which they were added.
  std::vector<protocol::Bookmark> of_scene(const std::string& scene) const;
  /// `camera`: what absent members are taken from.
  protocol::Result<void> add(const std::string& scene, const protocol::BookmarkAdd& request,
                             const protocol::Camera& camera);
  protocol::Result<void> rename(const std::string& scene, const protocol::BookmarkRename& request);
  protocol::Result<void> remove(const std::string& scene, const std::string& name);
  bool operator==(const Bookmarks&) const = default;

 private:
  struct Entry {
    std::string scene;
    protocol::Bookmark bookmark;
    bool operator==(const Entry&) const = default;
  };

  std::vector<Entry>::iterator find(const std::string& scene, const std::string& name);
  std::string free_name(const std::string& scene);

  std::vector<Entry> entries_;
};

}  // namespace heliograph::session
