#include "session/session.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "recording_link.hpp"

namespace heliograph::session {
namespace {

using nlohmann::json;
using protocol::CameraSet;
using protocol::ErrorCode;
using protocol::Vec3;
using test::RecordingLink;

class SessionTest : public testing::Test {
 protected:
  SessionTest() : session_(options(), std::make_shared<WakeEvent>()) {}

  static SessionOptions options() {
    SessionOptions options;
    options.width = 640;
    options.height = 360;
    options.limits.max_viewers = 2;
    options.limits.max_captures = 1;
    return options;
  }

  static LoadedScene a_scene() {
    auto scene = std::make_shared<scene::Scene>();
    scene->bounds.include(glm::vec3(-1.0f));
    scene->bounds.include(glm::vec3(1.0f));
    scene::Camera near;
    near.name = "near";
    near.eye = {0.0f, 0.0f, 3.0f};
    scene::Camera far = near;
    far.name = "far";
    far.eye = {0.0f, 0.0f, 30.0f};
    scene->cameras = {near, far};
    return {.name = "box", .scene = scene, .resources = nullptr};
  }

  struct Joined {
    std::shared_ptr<RecordingLink> link = std::make_shared<RecordingLink>();
    std::string id;
  };
  Joined join() {
    Joined joined;
    joined.id = "v" + std::to_string(++joined_so_far_);
    EXPECT_TRUE(session_.viewers().join(joined.id, joined.link));
    session_.viewers().start(joined.id);
    return joined;
  }

  int joined_so_far_ = 0;
  Session session_;
};

TEST_F(SessionTest, CommandsFailAsNotReadyWithoutAScene) {
  EXPECT_EQ(session_.camera().get().error().code, ErrorCode::not_ready);
  EXPECT_EQ(session_.scene().info().error().code, ErrorCode::not_ready);
  EXPECT_EQ(session_.captures().request_capture({}).error().code, ErrorCode::not_ready);
}

TEST_F(SessionTest, ShowingASceneSelectsItsFirstCamera) {
  session_.scene().show(a_scene(), "");
  const auto camera = session_.camera().get();
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->name, "near");
  EXPECT_EQ(camera->eye, (Vec3{0.0f, 0.0f, 3.0f}));
  EXPECT_EQ(session_.scene().info()->cameras, (std::vector<std::string>{"near", "far"}));
}

TEST_F(SessionTest, ASceneWithoutCamerasIsFitted) {
  LoadedScene loaded = a_scene();
  auto bare = std::make_shared<scene::Scene>(*loaded.scene);
  bare->cameras.clear();
  loaded.scene = bare;
  session_.scene().show(std::move(loaded), "");
  const auto camera = session_.camera().get();
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->name, std::nullopt);
  const Vec3 eye = camera->eye;
  EXPECT_GT(glm::length(glm::vec3(eye[0], eye[1], eye[2])), 1.7f) << "inside the box";
}

TEST_F(SessionTest, CameraSetKeepsOmittedMembers) {
  session_.scene().show(a_scene(), "");
  const auto moved = session_.camera().set({.eye = Vec3{5, 1, 2}, .vertical_fov = 60.0f}, "");
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->eye, (Vec3{5, 1, 2}));
  EXPECT_EQ(moved->target, (Vec3{0, 0, 0}));
  EXPECT_EQ(moved->vertical_fov, 60.0f);
  EXPECT_EQ(moved->name, std::nullopt) << "a moved camera is no longer the scene's";
}

TEST_F(SessionTest, CameraSetAppliesMembersOnTopOfTheNamedCamera) {
  session_.scene().show(a_scene(), "");
  EXPECT_EQ(session_.camera().set({.name = "far"}, "")->name, "far");
  const auto adjusted = session_.camera().set({.vertical_fov = 20.0f, .name = "far"}, "");
  EXPECT_EQ(adjusted->eye, (Vec3{0, 0, 30}));
  EXPECT_EQ(adjusted->name, std::nullopt);
  const auto unknown = session_.camera().set({.name = "fat"}, "");
  EXPECT_EQ(unknown.error().code, ErrorCode::not_found);
  EXPECT_NE(unknown.error().message.find("far"), std::string::npos);
}

TEST_F(SessionTest, ARefusedCameraSetChangesNothing) {
  session_.scene().show(a_scene(), "");
  const auto before = session_.camera().get();
  EXPECT_EQ(session_.camera().set({.eye = Vec3{2, 2, 2}, .target = Vec3{2, 2, 2}}, "").error().path,
            "target");
  EXPECT_EQ(session_.camera().set({.eye = Vec3{0, 0, 0}}, "").error().path, "eye");
  EXPECT_EQ(session_.camera().set({.up = Vec3{0, 0, 0}}, "").error().path, "up");
  EXPECT_EQ(*session_.camera().get(), *before);
}

class FollowingSession : public SessionTest {
 protected:
  FollowingSession() {
    session_.scene().show(a_scene(), "");
    SessionOptions options = SessionTest::options();
    options.name = "view";
    options.follows = "main";
    follower_ = std::make_shared<Session>(options, std::make_shared<WakeEvent>());
    Session::follow(follower_, session_);
    EXPECT_TRUE(follower_->viewers().join("w", link_));
    follower_->viewers().start("w");
    link_->messages.clear();
  }

  std::vector<std::string> heard() const {
    std::vector<std::string> methods;
    for (const json& message : link_->messages) methods.push_back(message["method"]);
    return methods;
  }

  std::shared_ptr<RecordingLink> link_ = std::make_shared<RecordingLink>();
  std::shared_ptr<Session> follower_;
};

TEST_F(FollowingSession, BeginsWithTheCameraAndThenHasItsOwn) {
  EXPECT_EQ(follower_->camera().get()->name, "near");
  const std::uint64_t version = follower_->version();
  ASSERT_TRUE(session_.camera().set({.eye = Vec3{5, 1, 2}}, ""));
  EXPECT_EQ(follower_->camera().get()->eye, (Vec3{0, 0, 3}));
  EXPECT_EQ(follower_->version(), version) << "nothing is to be rendered again";
  EXPECT_TRUE(heard().empty());
  ASSERT_TRUE(follower_->camera().set({.eye = Vec3{0, 4, 4}}, "w"));
  EXPECT_EQ(session_.camera().get()->eye, (Vec3{5, 1, 2}));
}

TEST_F(FollowingSession, FollowsSettingsSceneAndTimeAndTellsItsViewers) {
  ASSERT_TRUE(follower_->camera().set({.eye = Vec3{0, 4, 4}}, "w"));
  const std::uint32_t rev = follower_->rev();
  ASSERT_TRUE(
      session_.patch_settings(protocol::RawJson(json{{"exposure", {{"compensation", 2.0}}}}), ""));
  EXPECT_EQ(follower_->render_state().settings.exposure.compensation, 2.0f);
  ASSERT_EQ(heard(), std::vector<std::string>{"settings.changed"});
  EXPECT_EQ(link_->messages.back()["params"]["rev"], rev + 1) << "revisions are its own";
  EXPECT_EQ(follower_->camera().get()->eye, (Vec3{0, 4, 4}));

  LoadedScene other = a_scene();
  other.name = "other";
  session_.scene().show(std::move(other), "");
  EXPECT_EQ(follower_->scene().info()->name, "other");
  EXPECT_EQ(follower_->camera().get()->eye, (Vec3{0, 0, 3})) << "a new scene has a new camera";
  EXPECT_EQ(heard().back(), "scene.changed");
}

TEST_F(FollowingSession, ItsSizeIsThatOfItsViewer) {
  ASSERT_TRUE(follower_->configure_stream({.width = 320, .height = 200}, "w", true));
  EXPECT_EQ(follower_->render_state().width, 320u);
  EXPECT_EQ(session_.render_state().width, 640u);
}

TEST_F(SessionTest, EveryChangeIncrementsTheRevision) {
  session_.scene().show(a_scene(), "");
  const std::uint32_t first = session_.rev();
  ASSERT_TRUE(session_.camera().set({.eye = Vec3{1, 2, 3}}, ""));
  EXPECT_EQ(session_.rev(), first + 1);
  const protocol::RawJson patch(json{{"exposure", {{"compensation", 1.0}}}});
  EXPECT_EQ(session_.patch_settings(patch, "")->rev, first + 2);
  EXPECT_EQ(session_.patch_settings(patch, "")->rev, first + 2) << "nothing changed";
  EXPECT_EQ(session_.render_state().settings.exposure.compensation, 1.0f);
}

TEST_F(SessionTest, AnInvalidSettingsPatchAppliesNothing) {
  const protocol::RawJson patch(
      json{{"exposure", {{"compensation", 1.0}}}, {"view", {{"buffer", "gbuffer.norml"}}}});
  const auto refused = session_.patch_settings(patch, "");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid_params);
  EXPECT_EQ(refused.error().path, "view.buffer");
  EXPECT_NE(refused.error().message.find("gbuffer.normals"), std::string::npos);
  EXPECT_EQ(session_.render_state().settings, protocol::Settings());
}

TEST_F(SessionTest, NotifiesAllViewersButTheOneThatMadeTheChange) {
  session_.scene().show(a_scene(), "");
  const Joined author = join();
  const Joined other = join();
  ASSERT_TRUE(session_.camera().set({.eye = Vec3{1, 2, 3}}, author.id));
  ASSERT_TRUE(session_.patch_settings(protocol::RawJson(json{{"shadows", {{"enabled", false}}}}),
                                      author.id));
  session_.scene().show(a_scene(), author.id);
  EXPECT_TRUE(author.link->messages.empty());
  ASSERT_EQ(other.link->messages.size(), 3u);
  EXPECT_EQ(other.link->messages[0]["method"], "camera.changed");
  EXPECT_EQ(other.link->messages[0]["params"]["by"], author.id);
  EXPECT_EQ(other.link->messages[1]["params"]["patch"], (json{{"shadows", {{"enabled", false}}}}));
  EXPECT_EQ(other.link->messages[2]["method"], "scene.changed");
  EXPECT_EQ(other.link->keys, (std::vector<std::string>{"camera.changed", "", ""}))
      << "only absolute messages may replace each other";
}

TEST_F(SessionTest, EchoesInputsPerViewerUntilItLeaves) {
  session_.scene().show(a_scene(), "");
  const Joined viewer = join();
  ASSERT_TRUE(session_.camera().set({.eye = Vec3{1, 2, 3}, .seq = 12}, viewer.id));
  const RenderState state = session_.render_state();
  ASSERT_EQ(state.inputs.size(), 1u);
  EXPECT_EQ(state.inputs[0].viewer, viewer.id);
  EXPECT_EQ(state.inputs[0].seq, 12u);
  session_.leave(viewer.id);
  EXPECT_TRUE(session_.render_state().inputs.empty());
}

TEST_F(SessionTest, ClampsTheFrameSizeToTheLimit) {
  const Joined viewer = join();
  const auto stream = session_.configure_stream(
      {.width = 16384, .height = 200, .quality = 50, .max_fps = 10.0}, viewer.id);
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->width, 3840u);
  EXPECT_EQ(stream->height, 200u);
  EXPECT_EQ(stream->quality, 50u);
  EXPECT_EQ(session_.render_state().width, 3840u);
}

TEST_F(SessionTest, FramesSuitAllViewersAndThoseThatStay) {
  const Joined desktop = join();
  const Joined phone = join();
  const auto size = [&] {
    const RenderState state = session_.render_state();
    return FrameSize{state.width, state.height};
  };
  ASSERT_TRUE(session_.configure_stream({.width = 1280, .height = 720}, desktop.id));
  const auto stream = session_.configure_stream({.width = 390, .height = 844}, phone.id);
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->width, 1280u) << "the phone shows the middle of it";
  EXPECT_EQ(size(), (FrameSize{1280, 720}));
  session_.leave(desktop.id);
  EXPECT_EQ(size(), (FrameSize{390, 844}));
  session_.leave(phone.id);
  EXPECT_EQ(size(), (FrameSize{390, 844}));
}

TEST_F(SessionTest, CallersWithoutAStreamCanOnlySetTheSize) {
  EXPECT_EQ(session_.configure_stream({.width = 320}, "")->width, 320u);
  EXPECT_EQ(session_.configure_stream({.quality = 50}, "").error().code, ErrorCode::not_ready);
}

TEST_F(SessionTest, StoppingAReferenceRestoresTheSettings) {
  session_.scene().show(a_scene(), "");
  const auto patch = [&](json members) {
    return session_.patch_settings(protocol::RawJson(std::move(members)), "");
  };
  ASSERT_TRUE(patch({{"accumulation", {{"enabled", false}, {"max_samples", 5}}},
                     {"reference", {{"use", "when_static"}, {"scope", "full"}}}}));
  const protocol::Settings before = session_.render_state().settings;
  ASSERT_TRUE(session_.reference().start({.samples = 9}, ""));
  ASSERT_TRUE(session_.reference().start({.samples = 7}, "")) << "started again with other samples";
  EXPECT_TRUE(session_.render_state().reference_started);
  Session copy(options(), std::make_shared<WakeEvent>());
  copy.copy_from(session_);
  for (Session* const session : {&session_, &copy}) {
    EXPECT_TRUE(session->render_state().settings.accumulation.enabled);
    ASSERT_TRUE(session->reference().stop(""));
    EXPECT_EQ(session->render_state().settings, before);
    EXPECT_FALSE(session->renders_without_viewers());
  }
}

TEST_F(SessionTest, SettingsThatDisableAReferenceEndIt) {
  session_.scene().show(a_scene(), "");
  ASSERT_TRUE(session_.reference().start({.samples = 9}, ""));
  ASSERT_TRUE(
      session_.patch_settings(protocol::RawJson(json{{"reference", {{"use", "off"}}},
                                                     {"accumulation", {{"max_samples", 32}}}}),
                              ""));
  EXPECT_FALSE(session_.renders_without_viewers());
  EXPECT_EQ(session_.render_state().settings.accumulation.max_samples, 32);
  ASSERT_TRUE(session_.reference().start({.samples = 12}, ""));
  ASSERT_TRUE(session_.reference().stop(""));
  EXPECT_EQ(session_.render_state().settings.accumulation.max_samples, 32);
}

TEST_F(SessionTest, ValidatesAndLimitsCaptures) {
  session_.scene().show(a_scene(), "");
  EXPECT_EQ(session_.captures().request_capture({.buffer = "depth"}).error().path, "buffer");
  EXPECT_TRUE(session_.captures().request_capture({.buffer = "gbuffer.normals"}));
  EXPECT_EQ(session_.captures().request_capture({.buffer = "gbuffer.normals"}).error().code,
            ErrorCode::full);
  EXPECT_EQ(session_.captures().take_captures().size(), 1u);
  EXPECT_TRUE(session_.captures().take_captures().empty());
}

}  // namespace
}  // namespace heliograph::session
