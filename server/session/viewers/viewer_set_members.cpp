#include <algorithm>
#include <utility>

#include "protocol/json/jsonrpc.hpp"
#include "session/viewers/viewer_set.hpp"

// Participants of a session, control, and messages to all.

namespace heliograph::session {

using protocol::Result;

Result<void> ViewerSet::join(const std::string& id, std::weak_ptr<ViewerLink> link,
                             bool read_only) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> capacity = check_capacity(); !capacity) return capacity;
  Viewer& viewer = viewers_[id];
  viewer.link = std::move(link);
  viewer.read_only = read_only;
  viewer.arrival = ++arrivals_;
  viewer.pacer.set_max_rate(viewer.stream.max_fps);
  return {};
}

Result<void> ViewerSet::check_capacity() const {
  if (viewers_.size() < max_viewers_) return {};
  return protocol::error::full("the session's maximum number of viewers is reached",
                               std::to_string(max_viewers_) + " viewers");
}

Result<void> ViewerSet::move_to(const std::string& viewer, ViewerSet& other) {
  Viewers::node_type moved;
  Control control_before;
  {
    const std::lock_guard lock(mutex_);
    moved = viewers_.extract(viewer);
    control_before = control_;
    control_.on_viewer_left(viewer);
  }
  const Result<void> accepted = other.accept(moved);
  if (accepted) return {};
  const std::lock_guard lock(mutex_);
  viewers_.insert(std::move(moved));
  control_ = control_before;
  return accepted;
}

/// Leaves `viewer` as it is when the session's maximum number of viewers is reached.
Result<void> ViewerSet::accept(Viewers::node_type& viewer) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> capacity = check_capacity(); !capacity) return capacity;
  if (viewer.empty()) return {};
  Viewer& accepted = viewers_.insert(std::move(viewer)).position->second;
  accepted.wanted.reset();
  accepted.pacer.drop_pending();
  accepted.discontinuous = true;
  accepted.offered = 0;
  accepted.planned = 0;
  accepted.arrival = ++arrivals_;
  if (accepted.started) offer_latest(accepted);
  on_capacity_.notify();
  return {};
}

std::vector<std::string> ViewerSet::disconnect_all(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> ids;
  for (const auto& [id, viewer] : viewers_) {
    ids.push_back(id);
    departed_ += viewer.pacer.totals();
    if (const auto link = viewer.link.lock()) link->disconnect(reason);
  }
  viewers_.clear();
  return ids;
}

void ViewerSet::leave(const std::string& viewer) {
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  departed_ += found->second.pacer.totals();
  viewers_.erase(found);
  control_.on_viewer_left(viewer);
}

void ViewerSet::want_size(const std::string& viewer, FrameSize size) {
  const std::lock_guard lock(mutex_);
  if (const Result<Viewer*> found = find(viewer)) (*found)->wanted = size;
}

std::vector<FrameSize> ViewerSet::wanted_sizes(const std::string& except) const {
  const std::lock_guard lock(mutex_);
  std::vector<FrameSize> sizes;
  for (const auto& [id, viewer] : viewers_) {
    if (id != except && viewer.wanted) sizes.push_back(*viewer.wanted);
  }
  return sizes;
}

bool ViewerSet::has_other_participant(const std::string& viewer) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(viewers_.begin(), viewers_.end(), [&](const auto& entry) {
    return entry.first != viewer && entry.second.started && !entry.second.read_only;
  });
}

void ViewerSet::set_name(const std::string& viewer, std::string name) {
  const std::lock_guard lock(mutex_);
  if (const Result<Viewer*> found = find(viewer)) (*found)->name = std::move(name);
}

std::optional<std::string> ViewerSet::name_of(const std::string& viewer) const {
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(viewer);
  return found == viewers_.end() ? std::nullopt : found->second.name;
}

bool ViewerSet::may_change(const std::string& viewer) const {
  const std::lock_guard lock(mutex_);
  return may_change_locked(viewer);
}

bool ViewerSet::may_change_locked(const std::string& viewer) const {
  const auto found = viewers_.find(viewer);
  if (found != viewers_.end() && found->second.read_only) return false;
  return control_.may_change(viewer);
}

Result<void> ViewerSet::change_control(const protocol::SessionControl& request,
                                       const std::string& by) {
  const std::lock_guard lock(mutex_);
  return control_.apply(request, by, [&](const std::string& viewer) {
    const auto found = viewers_.find(viewer);
    return found != viewers_.end() && !found->second.read_only;
  });
}

protocol::ControlMode ViewerSet::control_mode() const {
  const std::lock_guard lock(mutex_);
  return control_.mode();
}

bool ViewerSet::control_is_free() const {
  const std::lock_guard lock(mutex_);
  return control_.is_free();
}

std::vector<protocol::ViewerInfo> ViewerSet::participants(const std::string& you) const {
  const std::lock_guard lock(mutex_);
  return describe_participants(you);
}

std::vector<protocol::ViewerInfo> ViewerSet::describe_participants(const std::string& you) const {
  std::map<std::uint64_t, protocol::ViewerInfo> by_arrival;
  for (const auto& [id, viewer] : viewers_) {
    by_arrival[viewer.arrival] = {
        .viewer = id, .name = viewer.name, .control = may_change_locked(id), .you = id == you};
  }
  std::vector<protocol::ViewerInfo> participants;
  for (auto& [arrival, info] : by_arrival) participants.push_back(std::move(info));
  return participants;
}

void ViewerSet::announce_participants(protocol::SessionInfo session) {
  const std::lock_guard lock(mutex_);
  session.control = control_.mode();
  for (const auto& [id, viewer] : viewers_) {
    // Before hello a client does not expect messages.
    const auto link = viewer.started ? viewer.link.lock() : nullptr;
    if (!link) continue;
    session.viewers = describe_participants(id);
    link->send(protocol::make_notification<protocol::notifications::session_changed>(session),
               "session.changed");
  }
}

void ViewerSet::send_all(std::string_view text, std::string_view key) {
  send_others({}, text, key);
}

void ViewerSet::send_others(const std::string& except, std::string_view text,
                            std::string_view key) {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, viewer] : viewers_) {
    if (id == except) continue;
    if (const auto link = viewer.link.lock()) link->send(std::string(text), key);
  }
}

}  // namespace heliograph::session
