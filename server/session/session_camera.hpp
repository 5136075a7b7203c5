#pragma once

#include <string>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the camera of a session. Thread safe. `by` is the viewer that asks, empty for a
/// caller without a stream.
class SessionCamera {
 public:
  explicit SessionCamera(SessionCore& core) : core_(core) {}

  protocol::Result<protocol::Camera> get() const;
  /// How often it was moved.
  std::uint64_t moves() const;
  protocol::Result<protocol::Camera> set(const protocol::CameraSet& request, const std::string& by);
  protocol::Result<protocol::Camera> orbit(const protocol::CameraOrbit& request,
                                           const std::string& by);
  /// Shows the whole scene, or some of its nodes.
  protocol::Result<protocol::Camera> fit(const protocol::CameraFit& request, const std::string& by);

  /// Of the scene that is shown.
  protocol::BookmarkList bookmarks() const;
  protocol::Result<protocol::BookmarkList> add_bookmark(const protocol::BookmarkAdd& request,
                                                        const std::string& by);
  protocol::Result<protocol::BookmarkList> rename_bookmark(const protocol::BookmarkRename& request,
                                                           const std::string& by);
  protocol::Result<protocol::BookmarkList> remove_bookmark(const protocol::BookmarkName& request,
                                                           const std::string& by);

 private:
  /// Moves the camera that is shown by `change(camera)`, under the lock, and passes it on.
  template <class Request, class Change>
  protocol::Result<protocol::Camera> move(const Request& request, const std::string& by,
                                          const Change& change);
  protocol::Result<void> fit_locked(const protocol::CameraFit& request, CameraState& camera);
  /// Changes the bookmarks by `change(scene)`, under the lock. What frames show stays.
  template <class Change>
  protocol::Result<protocol::BookmarkList> change_bookmarks(const std::string& by,
                                                            const Change& change);
  protocol::BookmarkList bookmarks_locked() const;

  SessionCore& core_;
};

}  // namespace heliograph::session
