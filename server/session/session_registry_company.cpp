#include <utility>

#include "session/session_registry.hpp"

// What viewers of one scene share beyond their sessions: pointers, and a camera of one's own that
// is another viewer's.

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

std::string leader_of(const Session& session) {
  return session.follows().empty() ? session.name() : session.follows();
}

}  // namespace

std::vector<std::shared_ptr<Session>> SessionRegistry::company_of(const Session& session) const {
  const auto leader = sessions_.find(leader_of(session));
  if (leader == sessions_.end()) return {};
  std::vector<std::shared_ptr<Session>> company = followers_of(*leader->second);
  company.push_back(leader->second);
  return company;
}

std::shared_ptr<Session> SessionRegistry::session_of_viewer_locked(
    const std::string& viewer) const {
  const auto found = session_of_viewer_.find(viewer);
  return found == session_of_viewer_.end() ? nullptr : found->second;
}

Result<void> SessionRegistry::point(const std::string& viewer,
                                    std::optional<protocol::Vec3> position) {
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<Session> session = session_of_viewer_locked(viewer);
  if (!session) return error::not_ready("requires a WebSocket connection");
  const bool pointed = position ? !pointing_.insert(viewer).second : pointing_.erase(viewer) > 0;
  if (position || pointed) show_pointer(viewer, *session, position);
  return {};
}

/// Only the newest position of each pointer matters.
void SessionRegistry::show_pointer(const std::string& viewer, const Session& session,
                                   std::optional<protocol::Vec3> position) {
  using protocol::notifications::pointer_changed;
  const std::string text = protocol::make_notification<pointer_changed>(
      {.viewer = viewer, .name = session.viewers().name_of(viewer), .position = position});
  const std::string key = std::string(pointer_changed::name) + " " + viewer;
  for (const auto& one : company_of(session)) one->viewers().send_others(viewer, text, key);
}

Result<void> SessionRegistry::follow(const std::string& viewer, const std::string& followed) {
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<Session> own = session_of_viewer_locked(viewer);
  if (!own) return error::not_ready("requires a WebSocket connection");
  if (own->follows().empty()) {
    return error::conflict("session", "this viewer has no camera of its own; see session.detach");
  }
  const std::shared_ptr<Session> source = session_of_viewer_locked(followed);
  if (!source || source == own || leader_of(*source) != leader_of(*own)) {
    return error::not_found("viewer", "no other viewer of this scene has this id");
  }
  if (follows_in_turn(followed, viewer)) {
    return error::conflict("viewer", "follows this viewer already");
  }
  stop_following_locked(viewer);
  followed_[viewer] = followed;
  Session::follow_camera(own, *source, followed);
  return {};
}

/// Whether `viewer` has the camera of `followed`, over others or not.
bool SessionRegistry::follows_in_turn(const std::string& viewer,
                                      const std::string& followed) const {
  for (auto next = followed_.find(viewer); next != followed_.end();
       next = followed_.find(next->second)) {
    if (next->second == followed) return true;
  }
  return false;
}

void SessionRegistry::stop_following(const std::string& viewer) {
  const std::lock_guard lock(mutex_);
  stop_following_locked(viewer);
}

void SessionRegistry::stop_following_locked(const std::string& viewer) {
  const auto found = followed_.find(viewer);
  if (found == followed_.end()) return;
  const std::shared_ptr<Session> own = session_of_viewer_locked(viewer);
  const std::shared_ptr<Session> source = session_of_viewer_locked(found->second);
  if (own && source) Session::unfollow_camera(*own, *source);
  followed_.erase(found);
}

void SessionRegistry::part(const std::string& viewer, const Session& session) {
  if (pointing_.erase(viewer) > 0) show_pointer(viewer, session, std::nullopt);
  stop_following_locked(viewer);
  std::vector<std::string> left;
  for (const auto& [follower, followed] : followed_) {
    if (followed == viewer) left.push_back(follower);
  }
  using protocol::notifications::viewer_unfollowed;
  for (const std::string& follower : left) {
    stop_following_locked(follower);
    if (const std::shared_ptr<Session> own = session_of_viewer_locked(follower)) {
      own->viewers().send_all(protocol::make_notification<viewer_unfollowed>({.viewer = viewer}),
                              {});
    }
  }
}

}  // namespace heliograph::session
