#include "session/session_registry.hpp"

#include <gtest/gtest.h>

namespace heliograph::session {
namespace {

using protocol::ErrorCode;

class TestLink : public ViewerLink {
 public:
  void frame_ready() override {}
  void send(std::string, std::string_view) override {}
  void disconnect(std::string why) override { close_reason = std::move(why); }

  std::string close_reason;
};

class SessionRegistryTest : public testing::Test {
 protected:
  SessionRegistryTest() : registry_(limits(), named({}), open(), close()) {}

  static RegistryLimits limits() {
    return {.sessions = 3, .viewers = 3, .pixels = 1000, .followers = 1};
  }
  static SessionOptions named(std::string name, std::uint32_t width = 20) {
    SessionOptions options;
    options.name = std::move(name);
    options.width = width;
    options.height = 10;
    options.limits.max_viewers = 2;
    return options;
  }
  SessionRegistry::Open open() {
    return [](SessionOptions options, PixelShare pixels) {
      return std::make_shared<Session>(std::move(options), std::make_shared<WakeEvent>(),
                                       std::move(pixels));
    };
  }
  SessionRegistry::Close close() {
    return [this](const Session& session) { closed_.push_back(session.name()); };
  }
  std::string enter(const std::string& session) {
    links_.push_back(std::make_shared<TestLink>());
    const auto id = registry_.enter(session, links_.back());
    EXPECT_TRUE(id) << id.error().message;
    return id ? *id : std::string();
  }

  std::vector<std::string> closed_;
  std::vector<std::shared_ptr<TestLink>> links_;
  SessionRegistry registry_;
};

TEST_F(SessionRegistryTest, TheMainSessionCannotBeClosed) {
  EXPECT_EQ(registry_.main()->name(), "main");
  EXPECT_EQ(registry_.close("main", "").error().code, ErrorCode::conflict);
  EXPECT_TRUE(registry_.find("main"));
}

TEST_F(SessionRegistryTest, FindsSessionsByName) {
  ASSERT_TRUE(registry_.create(named("review")));
  EXPECT_EQ((*registry_.find("review"))->name(), "review");
  const auto unknown = registry_.find("reviev");
  EXPECT_EQ(unknown.error().code, ErrorCode::not_found);
  EXPECT_EQ(unknown.error().path, "session");
  EXPECT_NE(unknown.error().message.find("review"), std::string::npos);
  EXPECT_EQ(registry_.create(named("review")).error().code, ErrorCode::conflict);
  for (const char* bad : {"../etc", "a b", ".hidden", "ümlaut", "a/b"}) {
    EXPECT_EQ(registry_.create(named(bad)).error().code, ErrorCode::invalid_params) << bad;
  }
}

TEST_F(SessionRegistryTest, AViewerResumesInAPristineSessionOfTheSameNameOrCreatesOne) {
  const std::string viewer = enter("main");
  const auto resumed = registry_.resume(viewer, {"before", "main"}, named({}));
  ASSERT_TRUE(resumed);
  EXPECT_EQ(resumed->session->name(), "main");
  EXPECT_TRUE(resumed->first);

  const std::string other = enter("main");
  const auto separate = registry_.resume(other, {"elsewhere", "main"}, named({}));
  ASSERT_TRUE(separate) << separate.error().message;
  EXPECT_EQ(separate->session->name(), "main-elsewher");
  EXPECT_TRUE(separate->first);
}

TEST_F(SessionRegistryTest, AViewerDoesNotResumeInAModifiedSession) {
  registry_.main()->mark_modified();
  const auto resumed = registry_.resume(enter("main"), {"before", "main"}, named({}));
  ASSERT_TRUE(resumed) << resumed.error().message;
  EXPECT_EQ(resumed->session->name(), "main-before");
}

TEST_F(SessionRegistryTest, ViewersOfOneLostSessionMeetAgainAndTheFirstRestoresIt) {
  const std::string first = enter("main");
  const std::string second = enter("main");
  const Origin from{"before", "review"};
  const auto made = registry_.resume(first, from, named({}));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->session->name(), "review");
  made->session->viewers().start(first);
  const auto followed = registry_.resume(second, from, named({}));
  ASSERT_TRUE(followed) << followed.error().message;
  EXPECT_EQ(followed->session, made->session);
  EXPECT_FALSE(followed->first);
  EXPECT_EQ(registry_.session_of_viewer(second), made->session);
}

TEST_F(SessionRegistryTest, AReadOnlyViewerCreatesNoSession) {
  const std::string viewer = enter("main");
  const std::size_t before = registry_.count();
  EXPECT_EQ(registry_.resume(viewer, {"before", "review"}, {}).error().code, ErrorCode::not_found);
  EXPECT_EQ(registry_.count(), before);
}

TEST_F(SessionRegistryTest, GeneratesNamesForUnnamedSessions) {
  ASSERT_TRUE(registry_.create(named("session-1")));
  const auto session = registry_.create(named(""));
  ASSERT_TRUE(session);
  EXPECT_EQ((*session)->name(), "session-2");
}

TEST_F(SessionRegistryTest, FullErrorsNameTheLimit) {
  ASSERT_TRUE(registry_.create(named("a")));
  const auto large = registry_.create(named("b", 80));
  EXPECT_EQ(large.error().code, ErrorCode::full);
  EXPECT_NE(large.error().limit.find("1000 pixels"), std::string::npos);
  ASSERT_TRUE(registry_.create(named("b")));
  const auto fourth = registry_.create(named("c"));
  EXPECT_EQ(fourth.error().code, ErrorCode::full);
  EXPECT_EQ(fourth.error().limit, "3 sessions");
  ASSERT_TRUE(registry_.close("a", ""));
  EXPECT_TRUE(registry_.create(named("c")));
}

TEST_F(SessionRegistryTest, AResizeIsLimitedByThePixelBudget) {
  const auto session = *registry_.create(named("a"));
  EXPECT_TRUE(session->configure_stream({.width = 80}, ""));
  EXPECT_EQ(session->configure_stream({.width = 81}, "").error().code, ErrorCode::full);
  EXPECT_EQ(session->render_state().width, 80u) << "a refused size changes nothing";
  EXPECT_EQ(registry_.pixels_used(), 1000u);
  EXPECT_TRUE(session->configure_stream({.width = 40}, ""));
  EXPECT_TRUE(registry_.main()->configure_stream({.width = 60}, ""));
}

TEST_F(SessionRegistryTest, AnEndedSessionReleasesItsPixels) {
  ASSERT_TRUE(registry_.create(named("a", 80)));
  ASSERT_TRUE(registry_.close("a", ""));
  EXPECT_EQ(registry_.pixels_used(), 200u);
  EXPECT_EQ(closed_, std::vector<std::string>{"a"});
}

TEST_F(SessionRegistryTest, AViewWithItsOwnCameraEndsWhenItsViewerLeavesIt) {
  const std::string viewer = enter("main");
  const auto view = registry_.detach(viewer, named({}));
  ASSERT_TRUE(view) << view.error().message;
  EXPECT_EQ((*view)->follows(), "main");
  EXPECT_EQ(registry_.session_of_viewer(viewer), *view);
  EXPECT_EQ(registry_.detach(viewer, named({})).error().code, ErrorCode::conflict);
  // It is the view of one viewer.
  const std::string other = enter("main");
  EXPECT_EQ(registry_.move(other, (*view)->name()).error().code, ErrorCode::not_found);
  EXPECT_EQ(registry_.enter((*view)->name(), links_.back()).error().code, ErrorCode::not_found);
  ASSERT_TRUE(registry_.move(viewer, "main"));
  EXPECT_EQ(closed_, std::vector<std::string>{(*view)->name()});
  const auto again = registry_.detach(viewer, named({}));
  ASSERT_TRUE(again);
  registry_.leave(viewer);
  EXPECT_EQ(closed_.back(), (*again)->name());
  EXPECT_EQ(registry_.count(), 1u);
}

TEST_F(SessionRegistryTest, ViewsOfASessionEndWithItAndAreLimited) {
  ASSERT_TRUE(registry_.create(named("a")));
  const std::string first = enter("a");
  const std::string second = enter("a");
  ASSERT_TRUE(registry_.detach(first, named({})));
  const auto more = registry_.detach(second, named({}));
  EXPECT_EQ(more.error().code, ErrorCode::full);
  EXPECT_EQ(more.error().limit, "1 viewers");
  EXPECT_EQ(registry_.session_of_viewer(second)->name(), "a") << "it stays where it was";
  ASSERT_TRUE(registry_.close("a", "the end"));
  EXPECT_EQ(registry_.count(), 1u);
  EXPECT_EQ(links_.front()->close_reason, "the end");
}

TEST_F(SessionRegistryTest, CallsAreForTheViewersSessionOrTheNamedOne) {
  ASSERT_TRUE(registry_.create(named("a")));
  const std::string viewer = enter("a");
  EXPECT_EQ((*registry_.session_of({.viewer = viewer}))->name(), "a");
  EXPECT_EQ((*registry_.session_of({.viewer = viewer, .session = "main"}))->name(), "a");
  EXPECT_EQ((*registry_.session_of({.viewer = {}, .session = "a"}))->name(), "a");
  EXPECT_EQ((*registry_.session_of(protocol::CallContext()))->name(), "main");
  EXPECT_EQ(registry_.session_of({.viewer = {}, .session = "b"}).error().code,
            ErrorCode::not_found);
}

TEST_F(SessionRegistryTest, AViewerThatMovesKeepsItsStream) {
  const auto there = *registry_.create(named("a"));
  const std::string viewer = enter("main");
  ASSERT_TRUE(registry_.main()->configure_stream({.quality = 33}, viewer));
  ASSERT_TRUE(registry_.move(viewer, "a"));
  EXPECT_EQ(registry_.session_of_viewer(viewer), there);
  EXPECT_EQ(registry_.main()->viewers().totals().viewers, 0u);
  EXPECT_EQ(there->configure_stream({.max_fps = 10.0}, viewer)->quality, 33u);
  EXPECT_EQ(registry_.move(viewer, "nowhere").error().code, ErrorCode::not_found);
  EXPECT_EQ(registry_.move("v99", "a").error().code, ErrorCode::not_ready);
}

TEST_F(SessionRegistryTest, AViewerStaysWhereTheOtherSessionIsFull) {
  ASSERT_TRUE(registry_.create(named("a")));
  enter("a");
  enter("a");
  const std::string viewer = enter("main");
  EXPECT_EQ(registry_.move(viewer, "a").error().code, ErrorCode::full);
  EXPECT_EQ(registry_.session_of_viewer(viewer), registry_.main());
  EXPECT_EQ(registry_.main()->viewers().totals().viewers, 1u);
  EXPECT_EQ(registry_.enter("main", std::make_shared<TestLink>()).error().limit, "3 viewers");
}

TEST_F(SessionRegistryTest, ViewersOfAnEndedSessionReceiveTheReason) {
  ASSERT_TRUE(registry_.create(named("a")));
  const std::string viewer = enter("a");
  ASSERT_TRUE(registry_.close("a", "it was closed"));
  EXPECT_EQ(links_.back()->close_reason, "it was closed");
  EXPECT_EQ(registry_.session_of_viewer(viewer), nullptr);
  EXPECT_EQ(registry_.session_of({.viewer = viewer}).error().code, ErrorCode::not_found);
  EXPECT_EQ(registry_.totals().viewers, 0u);
  registry_.leave(viewer);
}

}  // namespace
}  // namespace heliograph::session
