#include "session/viewers/control.hpp"

#include <gtest/gtest.h>

#include <set>

namespace heliograph::session {
namespace {

using protocol::ControlAction;
using protocol::ControlMode;
using protocol::ErrorCode;
using protocol::SessionControl;

class ControlTest : public testing::Test {
 protected:
  protocol::Result<void> ask(const std::string& by, const SessionControl& request) {
    return control_.apply(request, by,
                          [&](const std::string& id) { return present_.contains(id); });
  }
  std::string holders() const {
    std::string all;
    for (const std::string id : {"a", "b"}) all += control_.may_change(id) ? id : "";
    return all;
  }

  std::set<std::string> present_{"a", "b"};
  Control control_;
};

TEST_F(ControlTest, AllViewersHaveItAtFirst) {
  EXPECT_EQ(holders(), "ab");
  EXPECT_TRUE(control_.may_change("")) << "a caller without a stream";
  EXPECT_EQ(ask("a", {.action = ControlAction::take}).error().code, ErrorCode::conflict);
  EXPECT_EQ(ask("a", {}).error().code, ErrorCode::invalid_params);
}

TEST_F(ControlTest, TheViewerThatRequestsExclusiveControlGetsIt) {
  ASSERT_TRUE(ask("a", {.mode = ControlMode::exclusive}));
  EXPECT_EQ(holders(), "a");
  EXPECT_FALSE(control_.may_change(""));
  EXPECT_EQ(ask("b", {.mode = ControlMode::shared}).error().code, ErrorCode::forbidden);
  EXPECT_EQ(ask("b", {.mode = ControlMode::exclusive}).error().code, ErrorCode::forbidden);
  EXPECT_EQ(ask("b", {.action = ControlAction::take}).error().code, ErrorCode::forbidden);
  EXPECT_EQ(ask("b", {.action = ControlAction::release}).error().code, ErrorCode::forbidden);
  EXPECT_EQ(ask("b", {.action = ControlAction::give, .viewer = "b"}).error().code,
            ErrorCode::forbidden);
  EXPECT_EQ(holders(), "a");
  ASSERT_TRUE(ask("a", {.mode = ControlMode::shared}));
  EXPECT_EQ(holders(), "ab");
}

TEST_F(ControlTest, CanBeGivenReleasedAndTaken) {
  ASSERT_TRUE(ask("a", {.mode = ControlMode::exclusive}));
  EXPECT_EQ(ask("a", {.action = ControlAction::give, .viewer = "c"}).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(ask("a", {.action = ControlAction::give}).error().path, "viewer");
  ASSERT_TRUE(ask("a", {.action = ControlAction::give, .viewer = "b"}));
  EXPECT_EQ(holders(), "b");
  ASSERT_TRUE(ask("b", {.action = ControlAction::release}));
  EXPECT_EQ(holders(), "");
  ASSERT_TRUE(ask("a", {.mode = ControlMode::exclusive}));
  EXPECT_EQ(holders(), "a");
}

TEST_F(ControlTest, IsFreeAfterItsHolderLeaves) {
  ASSERT_TRUE(ask("a", {.mode = ControlMode::exclusive}));
  control_.on_viewer_left("b");
  EXPECT_EQ(holders(), "a");
  control_.on_viewer_left("a");
  EXPECT_EQ(holders(), "");
  ASSERT_TRUE(ask("b", {.action = ControlAction::take}));
  EXPECT_EQ(holders(), "b");
}

TEST_F(ControlTest, CallersWithoutAStreamCanAssignIt) {
  ASSERT_TRUE(ask("", {.mode = ControlMode::exclusive}));
  EXPECT_EQ(holders(), "") << "no viewer: only programs change the session";
  EXPECT_TRUE(control_.may_change(""));
  ASSERT_TRUE(ask("", {.mode = ControlMode::exclusive, .viewer = "a"}));
  ASSERT_TRUE(ask("", {.action = ControlAction::give, .viewer = "b"}));
  EXPECT_EQ(holders(), "b");
  ASSERT_TRUE(ask("", {.mode = ControlMode::shared}));
  EXPECT_EQ(holders(), "ab");
}

TEST_F(ControlTest, RefusedRequestsChangeNothing) {
  EXPECT_EQ(ask("a", {.mode = ControlMode::exclusive, .viewer = "c"}).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(holders(), "ab");
}

}  // namespace
}  // namespace heliograph::session
