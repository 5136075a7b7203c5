#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/json/jsonrpc.hpp"
#include "session/rendering/pixel_budget.hpp"
#include "session/session.hpp"

namespace heliograph::session {

/// Limits of all sessions together. Beyond them the answer is ErrorCode::full; existing sessions
/// and viewers are not affected.
struct RegistryLimits {
  std::size_t sessions = 64;
  std::size_t viewers = 256;
  std::uint64_t pixels = 8ull * 3840 * 2160;
  std::size_t followers = 8;  // of one session, each for a viewer with a camera of its own
  /// A session other than main is closed after so long without viewers and calls; zero: never.
  std::chrono::seconds idle_timeout{600};
};

/// A session of one server run.
struct Origin {
  std::string instance;
  std::string session;
  bool operator==(const Origin&) const = default;
};

/// Where a viewer of an earlier server run is now.
struct Resumed {
  std::shared_ptr<Session> session;
  bool first = false;  // no viewer has restored its state yet
};

/// The sessions by name, and the session of each viewer. "main" always exists. Thread safe.
class SessionRegistry {
 public:
  using Open = std::function<std::shared_ptr<Session>(SessionOptions, PixelShare)>;
  using Close = std::function<void(const Session&)>;

  /// `open` makes sessions that are rendered, `close` ends that.
  /// @throws what `open` throws for the main session
  SessionRegistry(const RegistryLimits& limits, SessionOptions main, Open open, Close close);

  /// A new session; an empty name in `options` is replaced by a generated one.
  protocol::Result<std::shared_ptr<Session>> create(SessionOptions options);
  /// The error for closing the main session.
  static protocol::Error main_always_exists();
  /// Ends a session. Its viewers receive the reason and are disconnected.
  protocol::Result<void> close(const std::string& name, const std::string& reason);
  /// Ends the sessions that are past their idle timeout; gives the time until the next check.
  Clock::duration close_idle();

  protocol::Result<std::shared_ptr<Session>> find(std::string_view name) const;
  /// The session that a call is for.
  protocol::Result<std::shared_ptr<Session>> session_of(const protocol::CallContext& call) const;
  /// The session that a viewer is in, or null.
  std::shared_ptr<Session> session_of_viewer(const std::string& viewer) const;
  const std::shared_ptr<Session>& main() const { return main_; }
  /// All sessions, by name.
  std::vector<std::shared_ptr<Session>> all() const;

  /// Adds a new viewer; gives its id.
  protocol::Result<std::string> enter(const std::string& session, std::weak_ptr<ViewerLink> link,
                                      bool read_only = false);
  /// Moves a viewer to another session, with its stream as it is.
  protocol::Result<std::shared_ptr<Session>> move(const std::string& viewer,
                                                  const std::string& session);
  /// Moves a viewer to a new session, made with `options`, that follows its session with a camera
  /// of its own. It ends when the viewer leaves it or its leader ends.
  protocol::Result<std::shared_ptr<Session>> detach(const std::string& viewer,
                                                    SessionOptions options);
  /// Moves a viewer that was in a session of another server run to where it disturbs no other
  /// viewer: to the session of those that were there with it; else to the session of that name
  /// while it is pristine; else to a new one, of that name if it is free, made with `options`.
  /// Without options, for a read-only viewer, to the session of that name as it is.
  protocol::Result<Resumed> resume(const std::string& viewer, const Origin& from,
                                   std::optional<SessionOptions> options);
  void leave(const std::string& viewer);

  // What viewers of one scene share beyond their sessions: those of a session and of all that
  // follow it.

  /// Shows all of them but the viewer itself what it points at; no position: nothing.
  protocol::Result<void> point(const std::string& viewer, std::optional<protocol::Vec3> position);
  /// The camera of the viewer, which must be its own, is from now on that of `followed`, another of
  /// them. Ends when either leaves its session, which the viewer is told, or with `stop_following`.
  protocol::Result<void> follow(const std::string& viewer, const std::string& followed);
  /// The camera of the viewer stays where it is; does nothing while it follows no one.
  void stop_following(const std::string& viewer);

  /// Of all sessions, ended ones included.
  ViewerTotals totals() const;
  std::size_t count() const;
  std::uint64_t opened() const;
  const RegistryLimits& limits() const { return limits_; }
  std::uint64_t pixels_used() const { return pixels_->used(); }

 private:
  using Sessions = std::map<std::string, std::shared_ptr<Session>, std::less<>>;

  protocol::Result<std::shared_ptr<Session>> create_locked(SessionOptions options);
  protocol::Result<std::shared_ptr<Session>> move_locked(const std::string& viewer,
                                                         const std::string& session);
  std::vector<std::shared_ptr<Session>> followers_of(const Session& leader) const;
  /// All sessions that show the scene of this one: the one that it follows, or itself, and the
  /// followers.
  std::vector<std::shared_ptr<Session>> company_of(const Session& session) const;
  std::shared_ptr<Session> session_of_viewer_locked(const std::string& viewer) const;
  void show_pointer(const std::string& viewer, const Session& session,
                    std::optional<protocol::Vec3> position);
  bool follows_in_turn(const std::string& viewer, const std::string& followed) const;
  void stop_following_locked(const std::string& viewer);
  /// Ends what the viewer shares as a member of this session, before it leaves that.
  void part(const std::string& viewer, const Session& session);
  void end_if_left(const std::shared_ptr<Session>& session);
  bool is_available(const std::string& viewer, const std::string& name) const;
  std::string resumed_name(const Origin& from);
  protocol::Result<std::shared_ptr<Session>> find_locked(std::string_view name) const;
  std::chrono::seconds idle_timeout_of(const Session& session) const;
  void end(const std::shared_ptr<Session>& session, const std::string& reason);
  std::string generated_name();

  const RegistryLimits limits_;
  const Open open_;
  const Close close_;
  const std::shared_ptr<PixelBudget> pixels_;

  mutable std::mutex mutex_;
  Sessions sessions_;
  std::map<std::string, std::shared_ptr<Session>> session_of_viewer_;
  std::set<std::string> pointing_;               // viewers whose pointers others see
  std::map<std::string, std::string> followed_;  // whose camera viewers have, by their ids
  std::map<std::string, Origin> origins_;        // of sessions that replace lost ones
  std::uint64_t viewer_count_ = 0;
  std::uint64_t name_count_ = 0;
  std::uint64_t opened_ = 0;
  ViewerTotals ended_;
  std::shared_ptr<Session> main_;
};

}  // namespace heliograph::session
