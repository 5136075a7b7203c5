// A scene that viewers see without its textures while it is being loaded.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "session/session.hpp"
#include "tests/unit/session/recording_link.hpp"

namespace heliograph::session {
namespace {

using protocol::ErrorCode;
using test::RecordingLink;

LoadedScene seen_from(const std::string& name, float distance) {
  auto scene = std::make_shared<scene::Scene>();
  scene->bounds.include(glm::vec3(-1.0f));
  scene->bounds.include(glm::vec3(1.0f));
  scene->nodes = {{.name = name + " node"}};
  scene::Camera camera;
  camera.name = name + " camera";
  camera.eye = {0.0f, 0.0f, distance};
  scene->cameras = {camera};
  return {.name = name, .scene = scene, .resources = nullptr};
}

class FirstViewTest : public testing::Test {
 protected:
  FirstViewTest() {
    EXPECT_TRUE(session_.viewers().join("viewer", link_));
    session_.viewers().start("viewer");
  }

  void show_first() { session_.scene().show_first_view(first_.scene, nullptr, "viewer"); }
  std::size_t told_of_camera() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(link_->messages, [](const nlohmann::json& message) {
          return message.value("method", "") == "camera.changed";
        }));
  }

  const LoadedScene before_ = seen_from("before", 3.0f);
  const LoadedScene first_ = seen_from("hall", 5.0f);
  const LoadedScene whole_ = seen_from("hall", 5.0f);
  std::shared_ptr<RecordingLink> link_ = std::make_shared<RecordingLink>();
  Session session_{{}, std::make_shared<WakeEvent>()};
};

TEST_F(FirstViewTest, IsWhatFramesShowAndTheCameraActsOn) {
  session_.scene().show(before_, "");
  const std::uint64_t version = session_.version();
  show_first();
  EXPECT_NE(session_.version(), version);
  const RenderState state = session_.render_state();
  EXPECT_EQ(state.scene, first_.scene);
  EXPECT_TRUE(state.first_view);
  EXPECT_EQ(state.camera.eye, glm::vec3(0.0f, 0.0f, 5.0f));
  EXPECT_EQ(session_.camera().get()->name, "hall camera");
  EXPECT_EQ(told_of_camera(), 1u) << "also the viewer that loads it";
  EXPECT_EQ(session_.camera().set({.name = "before camera"}, "").error().code,
            ErrorCode::not_found);
  ASSERT_TRUE(session_.camera().fit({.nodes = {{0}}}, "").error().code == ErrorCode::invalid_params)
      << "the nodes are those of the scene that is seen, which has no meshes";
}

TEST_F(FirstViewTest, IsNotTheSessionsScene) {
  show_first();
  EXPECT_EQ(session_.scene().info().error().code, ErrorCode::not_ready);
  session_.scene().end_first_view();
  session_.scene().show(before_, "");
  show_first();
  EXPECT_EQ(session_.scene().info()->name, "before");
  EXPECT_EQ(session_.info("").scene, "before");
}

TEST_F(FirstViewTest, GivesTheWholeSceneItsCamera) {
  session_.scene().show(before_, "");
  show_first();
  ASSERT_TRUE(session_.camera().set({.eye = {{1.0f, 2.0f, 7.0f}}}, "viewer"));
  session_.scene().show(whole_, "viewer");
  const RenderState state = session_.render_state();
  EXPECT_FALSE(state.first_view);
  EXPECT_EQ(state.scene, whole_.scene);
  EXPECT_EQ(state.camera.eye, glm::vec3(1.0f, 2.0f, 7.0f));
  EXPECT_EQ(session_.scene().info()->name, "hall");
  session_.scene().show(before_, "");
  EXPECT_EQ(session_.camera().get()->name, "before camera") << "another scene has its own";
}

TEST_F(FirstViewTest, LeavesTheSceneBeforeAsItWas) {
  session_.scene().show(before_, "");
  ASSERT_TRUE(session_.camera().set({.eye = {{4.0f, 0.0f, 0.0f}}}, "viewer"));
  show_first();
  ASSERT_TRUE(session_.camera().set({.eye = {{0.0f, 9.0f, 0.0f}}, .seq = 12}, "viewer"));
  session_.scene().end_first_view();
  const RenderState state = session_.render_state();
  EXPECT_FALSE(state.first_view);
  EXPECT_EQ(state.scene, before_.scene);
  EXPECT_EQ(state.camera.eye, glm::vec3(4.0f, 0.0f, 0.0f));
  ASSERT_EQ(state.inputs.size(), 1u);
  EXPECT_EQ(state.inputs[0].seq, 12u) << "its viewer waits for the echo";
  EXPECT_EQ(told_of_camera(), 2u) << "its beginning and its end";
  const std::uint64_t version = session_.version();
  session_.scene().end_first_view();
  EXPECT_EQ(session_.version(), version) << "there is none any more";
}

TEST_F(FirstViewTest, IsNotMovedByInputForTheSceneBefore) {
  session_.scene().show(before_, "");
  const std::uint32_t since = session_.camera().get()->scene_rev;
  const protocol::CameraSet drag{.eye = {{4.0f, 0.0f, 0.0f}}, .seq = 9, .scene_rev = since};
  ASSERT_TRUE(session_.camera().set(drag, "viewer"));
  show_first();
  const auto refused = session_.camera().set(drag, "viewer");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::conflict);
  EXPECT_EQ(refused.error().path, "scene_rev");
  EXPECT_FALSE(session_.camera().orbit({.yaw = 40.0f, .scene_rev = since}, "viewer"));
  EXPECT_EQ(session_.camera().get()->name, "hall camera");
  const std::uint32_t first = session_.camera().get()->scene_rev;
  EXPECT_TRUE(session_.camera().set({.eye = {{0.0f, 2.0f, 8.0f}}, .scene_rev = first}, "viewer"));
  session_.scene().end_first_view();
  EXPECT_EQ(session_.camera().get()->scene_rev, since) << "it is the same scene again";
  EXPECT_FALSE(session_.camera().set({.eye = {{7.0f, 7.0f, 7.0f}}, .scene_rev = first}, "viewer"));
  EXPECT_TRUE(session_.camera().set(drag, "viewer"));
}

TEST_F(FirstViewTest, IsTheSameSceneWhenItIsComplete) {
  session_.scene().show(before_, "");
  show_first();
  const std::uint32_t first = session_.camera().get()->scene_rev;
  session_.scene().show(whole_, "viewer");
  EXPECT_EQ(session_.camera().get()->scene_rev, first) << "a drag goes on";
  EXPECT_TRUE(session_.camera().set({.eye = {{1.0f, 2.0f, 7.0f}}, .scene_rev = first}, "viewer"));
  session_.scene().show(before_, "viewer");
  EXPECT_NE(session_.camera().get()->scene_rev, first);
  EXPECT_FALSE(session_.camera().orbit({.yaw = 4.0f, .scene_rev = first}, "viewer"));
  EXPECT_TRUE(session_.camera().orbit({.yaw = 4.0f}, "viewer")) << "programs need not say it";
}

TEST_F(FirstViewTest, IsNotSeenInLockstep) {
  session_.scene().show(before_, "");
  show_first();
  ASSERT_TRUE(
      session_.timeline().request_step({.frames = 1, .dt = 0.1, .done = [](const auto&) {}}));
  EXPECT_EQ(session_.render_state().scene, before_.scene);
  EXPECT_EQ(session_.camera().get()->name, "before camera");
}

TEST_F(FirstViewTest, TellsTheCameraWhenProgramsHideItAndShowItAgain) {
  session_.scene().show(before_, "");
  const std::uint32_t since = session_.camera().get()->scene_rev;
  show_first();
  const std::uint32_t first = session_.camera().get()->scene_rev;
  std::size_t told = told_of_camera();
  const auto expect_told = [&](std::uint32_t scene_rev, const char* what) {
    EXPECT_EQ(told_of_camera(), ++told) << what;
    const auto newest = std::find_if(link_->messages.rbegin(), link_->messages.rend(),
                                     [](const nlohmann::json& message) {
                                       return message.value("method", "") == "camera.changed";
                                     });
    ASSERT_NE(newest, link_->messages.rend());
    const nlohmann::json& camera = newest->at("params").at("camera");
    EXPECT_EQ(camera.at("scene_rev"), scene_rev) << what;
    EXPECT_EQ(camera.at("rev"), session_.camera().get()->rev) << what;
  };
  const auto step = [&] {
    return session_.timeline().request_step(
        {.frames = 0, .viewer = "viewer", .done = [](const auto&) {}});
  };
  ASSERT_TRUE(step());
  expect_told(since, "lockstep begins");
  ASSERT_TRUE(step());
  EXPECT_EQ(told_of_camera(), told) << "it has begun before";
  session_.timeline().leave_lockstep("viewer");
  expect_told(first, "lockstep ends");
  ASSERT_TRUE(session_.reference().start({}, "viewer"));
  expect_told(since, "a reference begins");
  ASSERT_TRUE(session_.reference().start({}, "viewer"));
  EXPECT_EQ(told_of_camera(), told) << "it has begun before";
  ASSERT_TRUE(session_.reference().stop("viewer"));
  expect_told(first, "a reference ends");
  session_.scene().show(whole_, "viewer");
  ASSERT_TRUE(step());
  EXPECT_EQ(told_of_camera(), told) << "there is no other scene";
}

TEST_F(FirstViewTest, IsNoPartOfACopy) {
  session_.scene().show(before_, "");
  show_first();
  Session copy{{}, std::make_shared<WakeEvent>()};
  copy.copy_from(session_);
  EXPECT_EQ(copy.render_state().scene, before_.scene);
  const auto camera = copy.camera().get();
  EXPECT_EQ(camera->name, "before camera");
  EXPECT_EQ(camera->scene_rev, camera->rev) << "the copy counts its own revisions";
}

}  // namespace
}  // namespace heliograph::session
