#include "session/session_registry.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <utility>

#include "protocol/json/suggestions.hpp"
#include "session/event_log.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

bool is_name(std::string_view name) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.';
  };
  return !name.empty() && name.size() <= 64 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), plain);
}

protocol::Error belongs_to_viewer() {
  return error::not_found("session", "is the view of one viewer");
}

}  // namespace

SessionRegistry::SessionRegistry(const RegistryLimits& limits, SessionOptions main, Open open,
                                 Close close)
    : limits_(limits),
      open_(std::move(open)),
      close_(std::move(close)),
      pixels_(std::make_shared<PixelBudget>(limits.pixels)) {
  main.name = protocol::main_session;
  const Result<std::shared_ptr<Session>> created = create(std::move(main));
  if (!created) throw std::invalid_argument("the main session: " + created.error().message);
  main_ = *created;
}

Result<std::shared_ptr<Session>> SessionRegistry::create(SessionOptions options) {
  const std::lock_guard lock(mutex_);
  return create_locked(std::move(options));
}

Result<std::shared_ptr<Session>> SessionRegistry::create_locked(SessionOptions options) {
  if (options.name.empty()) options.name = generated_name();
  if (!is_name(options.name)) {
    return error::invalid("name", "is not a valid name of a session",
                          "1 to 64 letters, digits, dots, hyphens and underscores");
  }
  if (sessions_.contains(options.name)) {
    return error::conflict("name", "a session of this name already exists");
  }
  if (sessions_.size() >= limits_.sessions) {
    return error::full("the maximum number of sessions is reached",
                       std::to_string(limits_.sessions) + " sessions");
  }
  options.width = std::min(options.width, options.limits.max_width);
  options.height = std::min(options.height, options.limits.max_height);
  PixelShare share(pixels_);
  const Result<void> fits =
      share.resize(static_cast<std::uint64_t>(options.width) * options.height);
  if (!fits) return fits.error();
  const std::string name = options.name;
  std::shared_ptr<Session> session = open_(std::move(options), std::move(share));
  sessions_[name] = session;
  ++opened_;
  log_info({.session = name}, "the session was opened");
  return session;
}

Result<void> SessionRegistry::close(const std::string& name, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  const Result<std::shared_ptr<Session>> found = find_locked(name);
  if (!found) return found.error();
  if (*found == main_) return main_always_exists();
  end(*found, reason);
  return {};
}

protocol::Error SessionRegistry::main_always_exists() {
  return error::conflict("session", "the session main cannot be closed");
}

Clock::duration SessionRegistry::close_idle() {
  const std::lock_guard lock(mutex_);
  Clock::duration next = std::chrono::hours(1);
  std::vector<std::shared_ptr<Session>> idle;
  for (const auto& [name, session] : sessions_) {
    const auto leader = sessions_.find(session->follows());
    if (leader != sessions_.end()) leader->second->mark_used();
  }
  for (const auto& [name, session] : sessions_) {
    const Clock::duration timeout = idle_timeout_of(*session);
    if (session == main_ || timeout == Clock::duration::zero()) continue;
    const Clock::duration left = timeout - session->idle();
    if (left <= Clock::duration::zero()) {
      idle.push_back(session);
    } else {
      next = std::min(next, left);
    }
  }
  for (const auto& session : idle) {
    if (!session->ended()) end(session, "the session was idle");
  }
  return next;
}

/// The shorter of the server's timeout and the session's own; zero: it never ends by itself.
std::chrono::seconds SessionRegistry::idle_timeout_of(const Session& session) const {
  const std::chrono::seconds own = session.limits().idle_timeout;
  const std::chrono::seconds general = limits_.idle_timeout;
  if (own.count() == 0 || general.count() == 0) return std::max(own, general);
  return std::min(own, general);
}

void SessionRegistry::end(const std::shared_ptr<Session>& session, const std::string& reason) {
  const std::string& name = session->name();
  for (const auto& follower : followers_of(*session)) end(follower, reason);
  for (const auto& viewer : session->viewers().participants({})) part(viewer.viewer, *session);
  sessions_.erase(name);
  origins_.erase(name);
  const protocol::SessionClosed closed{.session = name, .reason = reason};
  session->viewers().send_all(
      protocol::make_notification<protocol::notifications::session_closed>(closed), {});
  for (const std::string& viewer : session->viewers().disconnect_all(reason)) {
    session_of_viewer_.erase(viewer);
  }
  ended_.sent += session->viewers().totals().sent;
  session->end();
  close_(*session);
  log_info({.session = name}, "the session ended: " + reason);
}

Result<std::shared_ptr<Session>> SessionRegistry::find(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  return find_locked(name);
}

Result<std::shared_ptr<Session>> SessionRegistry::find_locked(std::string_view name) const {
  const auto found = sessions_.find(name);
  if (found != sessions_.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& [known, session] : sessions_) names.push_back(known);
  return error::not_found("session",
                          "there is no such session" + protocol::suggestion(name, names));
}

Result<std::shared_ptr<Session>> SessionRegistry::session_of(
    const protocol::CallContext& call) const {
  if (call.viewer.empty()) return find(call.session);
  if (std::shared_ptr<Session> session = session_of_viewer(call.viewer)) return session;
  return error::not_found("session", "the session has ended");
}

std::shared_ptr<Session> SessionRegistry::session_of_viewer(const std::string& viewer) const {
  const std::lock_guard lock(mutex_);
  const auto found = session_of_viewer_.find(viewer);
  return found == session_of_viewer_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<Session>> SessionRegistry::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<Session>> list;
  for (const auto& [name, session] : sessions_) list.push_back(session);
  return list;
}

Result<std::string> SessionRegistry::enter(const std::string& session,
                                           std::weak_ptr<ViewerLink> link, bool read_only) {
  const std::lock_guard lock(mutex_);
  const Result<std::shared_ptr<Session>> found = find_locked(session);
  if (!found) return found.error();
  if (!(*found)->follows().empty()) return belongs_to_viewer();
  if (session_of_viewer_.size() >= limits_.viewers) {
    return error::full("the server's maximum number of viewers is reached",
                       std::to_string(limits_.viewers) + " viewers");
  }
  const std::string id = "v" + std::to_string(++viewer_count_);
  if (const auto joined = (*found)->viewers().join(id, std::move(link), read_only); !joined) {
    return joined.error();
  }
  session_of_viewer_[id] = *found;
  return id;
}

Result<std::shared_ptr<Session>> SessionRegistry::move(const std::string& viewer,
                                                       const std::string& session) {
  const std::lock_guard lock(mutex_);
  return move_locked(viewer, session);
}

Result<std::shared_ptr<Session>> SessionRegistry::move_locked(const std::string& viewer,
                                                              const std::string& session) {
  const auto here = session_of_viewer_.find(viewer);
  if (here == session_of_viewer_.end()) {
    return error::not_ready("requires a WebSocket connection");
  }
  const Result<std::shared_ptr<Session>> there = find_locked(session);
  if (!there || *there == here->second) return there;
  if (!(*there)->follows().empty() && !(*there)->viewers().empty()) return belongs_to_viewer();
  if (const auto moved = here->second->move_to(viewer, **there); !moved) return moved.error();
  part(viewer, *here->second);
  const std::shared_ptr<Session> before = std::exchange(here->second, *there);
  before->announce();
  (*there)->announce();
  end_if_left(before);
  return there;
}

Result<std::shared_ptr<Session>> SessionRegistry::detach(const std::string& viewer,
                                                         SessionOptions options) {
  const std::lock_guard lock(mutex_);
  const auto here = session_of_viewer_.find(viewer);
  if (here == session_of_viewer_.end()) return error::not_ready("requires a WebSocket connection");
  const std::shared_ptr<Session> leader = here->second;
  if (!leader->follows().empty()) {
    return error::conflict("session", "this viewer has a camera of its own already");
  }
  if (followers_of(*leader).size() >= limits_.followers) {
    return error::full("too many viewers have cameras of their own in this session",
                       std::to_string(limits_.followers) + " viewers");
  }
  options.name.clear();
  options.follows = leader->name();
  const Result<std::shared_ptr<Session>> created = create_locked(std::move(options));
  if (!created) return created;
  Session::follow(*created, *leader);
  const auto moved = move_locked(viewer, (*created)->name());
  if (!moved) end(*created, "its viewer stayed where it was");
  return moved;
}

std::vector<std::shared_ptr<Session>> SessionRegistry::followers_of(const Session& leader) const {
  std::vector<std::shared_ptr<Session>> followers;
  for (const auto& [name, session] : sessions_) {
    if (session->follows() == leader.name()) followers.push_back(session);
  }
  return followers;
}

/// A session for one viewer's camera is of no use without it.
void SessionRegistry::end_if_left(const std::shared_ptr<Session>& session) {
  if (session->follows().empty() || session->ended() || !session->viewers().empty()) return;
  const std::vector<std::shared_ptr<Session>> company = company_of(*session);
  end(session, "its viewer has left");
  for (const auto& other : company) {
    if (!other->ended()) other->announce();
  }
}

Result<Resumed> SessionRegistry::resume(const std::string& viewer, const Origin& from,
                                        std::optional<SessionOptions> options) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(origins_.begin(), origins_.end(),
                                  [&](const auto& entry) { return entry.second == from; });
  std::string name = known == origins_.end() ? from.session : known->first;
  if (!options) {
    const auto joined = move_locked(viewer, name);
    if (!joined) return joined.error();
    return Resumed{.session = *joined};
  }
  if (known == origins_.end() && !is_available(viewer, name)) {
    options->name = resumed_name(from);
    const auto created = create_locked(*std::move(options));
    if (!created) return created.error();
    name = (*created)->name();
  }
  const bool first = sessions_.at(name)->is_pristine(viewer);
  const auto moved = move_locked(viewer, name);
  if (!moved) return moved.error();
  origins_[name] = from;
  return Resumed{.session = *moved, .first = first};
}

/// Whether there is a pristine session of this name.
bool SessionRegistry::is_available(const std::string& viewer, const std::string& name) const {
  const auto found = sessions_.find(name);
  return found != sessions_.end() && !origins_.contains(name) && found->second->is_pristine(viewer);
}

/// The name that the session had, or one derived from it.
std::string SessionRegistry::resumed_name(const Origin& from) {
  if (!sessions_.contains(from.session)) return from.session;
  const std::string name = from.session.substr(0, 55) + "-" + from.instance.substr(0, 8);
  return sessions_.contains(name) || !is_name(name) ? generated_name() : name;
}

void SessionRegistry::leave(const std::string& viewer) {
  const std::lock_guard lock(mutex_);
  const auto found = session_of_viewer_.find(viewer);
  if (found == session_of_viewer_.end()) return;
  const std::shared_ptr<Session> session = found->second;
  part(viewer, *session);
  session->leave(viewer);
  session->announce();
  session_of_viewer_.erase(found);
  end_if_left(session);
}

std::size_t SessionRegistry::count() const {
  const std::lock_guard lock(mutex_);
  return sessions_.size();
}

std::uint64_t SessionRegistry::opened() const {
  const std::lock_guard lock(mutex_);
  return opened_;
}

ViewerTotals SessionRegistry::totals() const {
  const std::lock_guard lock(mutex_);
  ViewerTotals totals = ended_;
  std::size_t measured = 0;
  for (const auto& [name, session] : sessions_) {
    const ViewerTotals more = session->viewers().totals();
    totals.viewers += more.viewers;
    totals.waiting += more.waiting;
    totals.in_flight += more.in_flight;
    totals.sent += more.sent;
    totals.goodput += more.goodput;
    if (more.mean_round_trip.count() == 0) continue;
    totals.mean_round_trip += more.mean_round_trip;
    ++measured;
  }
  if (measured > 0) totals.mean_round_trip /= static_cast<std::int64_t>(measured);
  return totals;
}

std::string SessionRegistry::generated_name() {
  std::string name;
  do {
    name = "session-" + std::to_string(++name_count_);
  } while (sessions_.contains(name));
  return name;
}

}  // namespace heliograph::session
