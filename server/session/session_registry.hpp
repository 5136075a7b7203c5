#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/json/jsonrpc.hpp"
#include "session/rendering/pixel_budget.hpp"
#include "session/state/session.hpp"

namespace heliograph::session {

/// What all sessions together may take. Beyond it the answer is ErrorCode::full; nobody who is
/// there already gets less.
struct RegistryLimits {
  std::size_t sessions = 64;
  std::size_t viewers = 256;
  std::uint64_t pixels = 8ull * 3840 * 2160;
  /// A session other than main without viewers and calls for so long is closed; zero: never.
  std::chrono::seconds idle_timeout{600};
};

/// A session of some run of the server.
struct Origin {
  std::string instance;
  std::string session;
  bool operator==(const Origin&) const = default;
};

/// Where somebody who came from another run is now.
struct Resumed {
  std::shared_ptr<Session> session;
  bool first = false;  // nobody has brought its state yet
};

/// The sessions by name, and which viewer is in which of them. "main" is there from the start and
/// for good. Thread safe.
class SessionRegistry {
 public:
  using Open = std::function<std::shared_ptr<Session>(SessionOptions, PixelShare)>;
  using Close = std::function<void(const Session&)>;

  /// `open` makes sessions that are drawn, `close` ends that.
  /// @throws what `open` throws for the main session
  SessionRegistry(const RegistryLimits& limits, SessionOptions main, Open open, Close close);

  /// A new session; without a name in `options` it gets one.
  protocol::Result<std::shared_ptr<Session>> create(SessionOptions options);
  /// What who wants to close the main session is told.
  static protocol::Error main_stays();
  /// Ends a session. Its viewers are told why and let go.
  protocol::Result<void> close(const std::string& name, const std::string& why);
  /// Ends the sessions that nobody has needed for so long; gives the time until another look.
  Clock::duration close_idle();

  protocol::Result<std::shared_ptr<Session>> find(std::string_view name) const;
  /// The session that a call belongs to.
  protocol::Result<std::shared_ptr<Session>> session_of(const protocol::CallContext& call) const;
  /// The session that a viewer is in, or null.
  std::shared_ptr<Session> session_of_viewer(const std::string& viewer) const;
  const std::shared_ptr<Session>& main() const { return main_; }
  /// All sessions, by name.
  std::vector<std::shared_ptr<Session>> all() const;

  /// Takes in a new viewer; gives its id.
  protocol::Result<std::string> enter(const std::string& session, std::weak_ptr<ViewerLink> link,
                                      bool read_only = false);
  /// Brings a viewer into another session, with its stream as it is.
  protocol::Result<std::shared_ptr<Session>> move(const std::string& viewer,
                                                  const std::string& session);
  /// Brings a viewer that was in a session of another run of the server, perhaps elsewhere, to
  /// where it disturbs nobody: to those who were there with it; else into the session of that name,
  /// while it is is_pristine; else into a new one, of that name if it is free, made with `options`.
  /// Without them, for who may only watch, into the one of that name as it is.
  protocol::Result<Resumed> resume(const std::string& viewer, const Origin& from,
                                   std::optional<SessionOptions> options);
  void leave(const std::string& viewer);

  /// Of all sessions, those that have ended included.
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
  bool is_free_for(const std::string& viewer, const std::string& name) const;
  std::string name_for(const Origin& from);
  protocol::Result<std::shared_ptr<Session>> find_locked(std::string_view name) const;
  void end(const std::shared_ptr<Session>& session, const std::string& why);
  std::string free_name();

  const RegistryLimits limits_;
  const Open open_;
  const Close close_;
  const std::shared_ptr<PixelBudget> pixels_;

  mutable std::mutex mutex_;
  Sessions sessions_;
  std::map<std::string, std::shared_ptr<Session>> session_of_viewer_;
  std::map<std::string, Origin> origins_;  // of sessions that took the place of lost ones
  std::uint64_t viewers_so_far_ = 0;
  std::uint64_t names_so_far_ = 0;
  std::uint64_t opened_ = 0;
  ViewerTotals ended_;
  std::shared_ptr<Session> main_;
};

}  // namespace heliograph::session
