#include "session/state/session.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

namespace heliograph::session {
namespace {

using nlohmann::json;
using protocol::CameraSet;
using protocol::ErrorCode;
using protocol::Vec3;

/// Remembers what it was sent.
class RecordingLink : public ViewerLink {
 public:
  void frame_ready() override { ++announced; }
  void send(std::string text, std::string_view key) override {
    messages.push_back(json::parse(text));
    keys.emplace_back(key);
  }

  void disconnect(std::string why) override { disconnected = std::move(why); }

  int announced = 0;
  std::string disconnected;
  std::vector<json> messages;
  std::vector<std::string> keys;
};

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

TEST_F(SessionTest, WithoutASceneTellsThatItIsNotReady) {
  EXPECT_EQ(session_.camera().error().code, ErrorCode::not_ready);
  EXPECT_EQ(session_.scene_info().error().code, ErrorCode::not_ready);
  EXPECT_EQ(session_.request_capture({}).error().code, ErrorCode::not_ready);
}

TEST_F(SessionTest, ASceneBringsItsFirstCamera) {
  session_.show(a_scene(), "");
  const auto camera = session_.camera();
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->name, "near");
  EXPECT_EQ(camera->eye, (Vec3{0.0f, 0.0f, 3.0f}));
  EXPECT_EQ(session_.scene_info()->cameras, (std::vector<std::string>{"near", "far"}));
}

TEST_F(SessionTest, ASceneWithoutCamerasIsSeenWhole) {
  LoadedScene loaded = a_scene();
  auto bare = std::make_shared<scene::Scene>(*loaded.scene);
  bare->cameras.clear();
  loaded.scene = bare;
  session_.show(std::move(loaded), "");
  const auto camera = session_.camera();
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->name, std::nullopt);
  const Vec3 eye = camera->eye;
  EXPECT_GT(glm::length(glm::vec3(eye[0], eye[1], eye[2])), 1.7f) << "inside the box";
}

TEST_F(SessionTest, CameraMembersThatAreLeftOutStay) {
  session_.show(a_scene(), "");
  const auto moved = session_.set_camera({.eye = Vec3{5, 1, 2}, .vertical_fov = 60.0f}, "");
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->eye, (Vec3{5, 1, 2}));
  EXPECT_EQ(moved->target, (Vec3{0, 0, 0}));
  EXPECT_EQ(moved->vertical_fov, 60.0f);
  EXPECT_EQ(moved->name, std::nullopt) << "a moved camera is no longer the scene's";
}

TEST_F(SessionTest, ANamedCameraIsTheBaseOfTheRest) {
  session_.show(a_scene(), "");
  EXPECT_EQ(session_.set_camera({.name = "far"}, "")->name, "far");
  const auto adjusted = session_.set_camera({.vertical_fov = 20.0f, .name = "far"}, "");
  EXPECT_EQ(adjusted->eye, (Vec3{0, 0, 30}));
  EXPECT_EQ(adjusted->name, std::nullopt);
  const auto unknown = session_.set_camera({.name = "fat"}, "");
  EXPECT_EQ(unknown.error().code, ErrorCode::not_found);
  EXPECT_NE(unknown.error().message.find("far"), std::string::npos);
}

TEST_F(SessionTest, ARefusedCameraChangesNothing) {
  session_.show(a_scene(), "");
  const auto before = session_.camera();
  EXPECT_EQ(session_.set_camera({.eye = Vec3{2, 2, 2}, .target = Vec3{2, 2, 2}}, "").error().path,
            "target");
  EXPECT_EQ(session_.set_camera({.eye = Vec3{0, 0, 0}}, "").error().path, "eye");
  EXPECT_EQ(session_.set_camera({.up = Vec3{0, 0, 0}}, "").error().path, "up");
  EXPECT_EQ(*session_.camera(), *before);
}

TEST_F(SessionTest, EveryChangeHasItsRevision) {
  session_.show(a_scene(), "");
  const std::uint32_t first = session_.rev();
  ASSERT_TRUE(session_.set_camera({.eye = Vec3{1, 2, 3}}, ""));
  EXPECT_EQ(session_.rev(), first + 1);
  const protocol::RawJson patch(json{{"exposure", {{"compensation", 1.0}}}});
  EXPECT_EQ(session_.patch_settings(patch, "")->rev, first + 2);
  EXPECT_EQ(session_.patch_settings(patch, "")->rev, first + 2) << "nothing changed";
  EXPECT_EQ(session_.render_state().settings.exposure.compensation, 1.0f);
}

TEST_F(SessionTest, ABadPatchAppliesNothing) {
  const protocol::RawJson patch(
      json{{"exposure", {{"compensation", 1.0}}}, {"view", {{"buffer", "gbuffer.norml"}}}});
  const auto refused = session_.patch_settings(patch, "");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid_params);
  EXPECT_EQ(refused.error().path, "view.buffer");
  EXPECT_NE(refused.error().message.find("gbuffer.normals"), std::string::npos);
  EXPECT_EQ(session_.render_state().settings, protocol::Settings());
}

TEST_F(SessionTest, OthersHearOfChangesAndTheCauserDoesNot) {
  session_.show(a_scene(), "");
  const Joined causer = join();
  const Joined other = join();
  ASSERT_TRUE(session_.set_camera({.eye = Vec3{1, 2, 3}}, causer.id));
  ASSERT_TRUE(session_.patch_settings(protocol::RawJson(json{{"shadows", {{"enabled", false}}}}),
                                      causer.id));
  session_.show(a_scene(), causer.id);
  EXPECT_TRUE(causer.link->messages.empty());
  ASSERT_EQ(other.link->messages.size(), 3u);
  EXPECT_EQ(other.link->messages[0]["method"], "camera.changed");
  EXPECT_EQ(other.link->messages[0]["params"]["by"], causer.id);
  EXPECT_EQ(other.link->messages[1]["params"]["patch"], (json{{"shadows", {{"enabled", false}}}}));
  EXPECT_EQ(other.link->messages[2]["method"], "scene.changed");
  EXPECT_EQ(other.link->keys, (std::vector<std::string>{"camera.changed", "", ""}))
      << "only absolute messages may replace each other";
}

TEST_F(SessionTest, InputsAreEchoedPerViewerUntilTheyLeave) {
  session_.show(a_scene(), "");
  const Joined viewer = join();
  ASSERT_TRUE(session_.set_camera({.eye = Vec3{1, 2, 3}, .seq = 12}, viewer.id));
  const RenderState state = session_.render_state();
  ASSERT_EQ(state.inputs.size(), 1u);
  EXPECT_EQ(state.inputs[0].viewer, viewer.id);
  EXPECT_EQ(state.inputs[0].seq, 12u);
  session_.leave(viewer.id);
  EXPECT_TRUE(session_.render_state().inputs.empty());
}

TEST_F(SessionTest, PictureSizesAreCutToTheLimit) {
  const Joined viewer = join();
  const auto stream = session_.configure_stream(
      {.width = 16384, .height = 200, .quality = 50, .max_fps = 10.0}, viewer.id);
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->width, 3840u);
  EXPECT_EQ(stream->height, 200u);
  EXPECT_EQ(stream->quality, 50u);
  EXPECT_EQ(session_.render_state().width, 3840u);
}

TEST_F(SessionTest, WithoutAStreamOnlyTheSizeCanBeSet) {
  EXPECT_EQ(session_.configure_stream({.width = 320}, "")->width, 320u);
  EXPECT_EQ(session_.configure_stream({.quality = 50}, "").error().code, ErrorCode::not_ready);
}

TEST_F(SessionTest, AFullSessionSaysSo) {
  const Joined first = join();
  const Joined second = join();
  const auto third = session_.viewers().join("newcomer", std::make_shared<RecordingLink>());
  EXPECT_EQ(third.error().code, ErrorCode::full);
  session_.leave(first.id);
  EXPECT_TRUE(session_.viewers().join("newcomer", std::make_shared<RecordingLink>()));
}

TEST_F(SessionTest, StoppingAReferencePutsBackWhatStartingItChanged) {
  session_.show(a_scene(), "");
  const auto patch = [&](json members) {
    return session_.patch_settings(protocol::RawJson(std::move(members)), "");
  };
  ASSERT_TRUE(patch({{"accumulation", {{"enabled", false}, {"max_samples", 5}}},
                     {"reference", {{"use", "when_static"}, {"scope", "full"}}}}));
  const protocol::Settings before = session_.render_state().settings;
  ASSERT_TRUE(session_.start_reference({.samples = 9}, ""));
  ASSERT_TRUE(session_.start_reference({.samples = 7}, "")) << "goes on with other samples";
  EXPECT_TRUE(session_.render_state().keep_drawing);
  Session copy(options(), std::make_shared<WakeEvent>());
  copy.copy_from(session_);
  for (Session* const session : {&session_, &copy}) {
    EXPECT_TRUE(session->render_state().settings.accumulation.enabled);
    ASSERT_TRUE(session->stop_reference(""));
    EXPECT_EQ(session->render_state().settings, before);
    EXPECT_FALSE(session->renders_without_viewers());
  }
}

TEST_F(SessionTest, AReferenceThatSettingsEndIsNotStarted) {
  session_.show(a_scene(), "");
  ASSERT_TRUE(session_.start_reference({.samples = 9}, ""));
  ASSERT_TRUE(
      session_.patch_settings(protocol::RawJson(json{{"reference", {{"use", "never"}}},
                                                     {"accumulation", {{"max_samples", 32}}}}),
                              ""));
  EXPECT_FALSE(session_.renders_without_viewers());
  EXPECT_EQ(session_.render_state().settings.accumulation.max_samples, 32);
  ASSERT_TRUE(session_.start_reference({.samples = 12}, ""));
  ASSERT_TRUE(session_.stop_reference(""));
  EXPECT_EQ(session_.render_state().settings.accumulation.max_samples, 32);
}

TEST_F(SessionTest, CapturesAreCheckedAndLimited) {
  session_.show(a_scene(), "");
  EXPECT_EQ(session_.request_capture({.buffer = "depth"}).error().path, "buffer");
  EXPECT_TRUE(session_.request_capture({.buffer = "gbuffer.normals"}));
  EXPECT_EQ(session_.request_capture({.buffer = "gbuffer.normals"}).error().code, ErrorCode::full);
  EXPECT_EQ(session_.take_captures().size(), 1u);
  EXPECT_TRUE(session_.take_captures().empty());
}

/// What the encoder does, without pixels.
std::shared_ptr<stream::EncodedFrame> encoded(std::uint32_t render_id,
                                              const stream::EncodingVariant& form) {
  auto frame = std::make_shared<stream::EncodedFrame>();
  frame->variant = form;
  frame->header.render_id = render_id;
  frame->header.quality = static_cast<std::uint16_t>(form.quality);
  frame->header.width = frame->header.full_width = 16;
  frame->header.height = frame->header.full_height = 16;
  frame->payload.resize(100);
  frame->encoded_at = Clock::now();
  return frame;
}

/// Plans, encodes and hands out picture `number`; gives the forms it was encoded in.
std::vector<stream::EncodingVariant> show(ViewerSet& audience, std::uint32_t number,
                                          Purpose purpose = Purpose::interactive) {
  const EncodingPlan plan = audience.plan(number, purpose, 16 * 16);
  std::vector<stream::EncodingVariant> forms;
  std::vector<stream::SharedFrame> frames;
  for (const stream::VariantRequest& request : plan.forms) {
    forms.push_back(request.variant);
    frames.push_back(encoded(number, request.variant));
  }
  for (const protocol::StillFormat format : plan.stills) {
    const bool lossless = format == protocol::StillFormat::png;
    auto frame = encoded(number, {.quality = lossless ? 100 : 95});
    if (lossless) frame->header.codec = protocol::FrameCodec::png;
    forms.push_back(frame->variant);
    frames.push_back(frame);
  }
  audience.publish(number, purpose, frames);
  return forms;
}

TEST_F(SessionTest, ViewersGetTheirQualityAndShareTheBytes) {
  ViewerSet& audience = session_.viewers();
  const Joined first = join();
  const Joined second = join();
  ASSERT_TRUE(session_.configure_stream({.quality = 40}, first.id));
  EXPECT_EQ(show(audience, 7),
            (std::vector<stream::EncodingVariant>{{.quality = 40}, {.quality = 80}}));
  const auto low = audience.take(first.id);
  const auto high = audience.take(second.id);
  ASSERT_TRUE(low && high);
  EXPECT_EQ(protocol::decode_frame_header(low->header)->quality, 40);
  EXPECT_EQ(protocol::decode_frame_header(low->header)->frame_seq, 1u);
  EXPECT_EQ(protocol::decode_frame_header(high->header)->quality, 80);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(show(audience, 8, Purpose::final),
            (std::vector<stream::EncodingVariant>{{.quality = 95}}));
  EXPECT_EQ(audience.take(first.id)->frame, audience.take(second.id)->frame);
}

TEST_F(SessionTest, TheFinalPictureIsAPngForThoseWhoAskedForOne) {
  ViewerSet& audience = session_.viewers();
  const Joined first = join();
  const Joined second = join();
  const auto state = session_.configure_stream({.still = protocol::StillFormat::png}, second.id);
  EXPECT_EQ(state->still, protocol::StillFormat::png);
  EXPECT_EQ(show(audience, 1, Purpose::final).size(), 2u);
  EXPECT_EQ(audience.take(first.id)->frame->header.codec, protocol::FrameCodec::jpeg);
  EXPECT_EQ(audience.take(second.id)->frame->header.codec, protocol::FrameCodec::png);
}

TEST_F(SessionTest, AVideoIsOnlyForThoseWhoseHelloAgreedOnOne) {
  const Joined viewer = join();
  const auto refused = session_.configure_stream({.codec = protocol::StreamCodec::h264}, viewer.id);
  EXPECT_EQ(refused.error().path, "codec");
}

TEST_F(SessionTest, ANewcomerGetsTheLatestPicture) {
  const Joined first = join();
  show(session_.viewers(), 3, Purpose::final);
  const Joined viewer = join();
  EXPECT_GT(viewer.link->announced, 0);
  EXPECT_EQ(session_.viewers().take(viewer.id)->frame->header.render_id, 3u);
  EXPECT_FALSE(session_.viewers().needs_frame(3));
}

TEST_F(SessionTest, ANewcomerWhoWantsAnotherFormAwaitsThePicture) {
  ViewerSet& audience = session_.viewers();
  const Joined first = join();
  show(audience, 3);
  ASSERT_TRUE(audience.take(first.id));
  const Joined viewer = join();
  ASSERT_TRUE(session_.configure_stream({.quality = 40, .paused = true}, viewer.id));
  ASSERT_TRUE(session_.configure_stream({.paused = false}, viewer.id));
  EXPECT_TRUE(audience.needs_frame(3));
  EXPECT_EQ(show(audience, 3), (std::vector<stream::EncodingVariant>{{.quality = 40}}));
  EXPECT_EQ(audience.take(viewer.id)->frame->header.quality, 40);
  EXPECT_FALSE(audience.take(first.id)) << "it has this picture";
}

TEST_F(SessionTest, WhoHasAPictureIsNotSentItAgainWithANewcomer) {
  ViewerSet& audience = session_.viewers();
  const Joined first = join();
  show(audience, 1, Purpose::final);
  ASSERT_TRUE(audience.take(first.id));
  const Joined second = join();
  ASSERT_TRUE(session_.configure_stream({.still = protocol::StillFormat::png}, second.id));
  EXPECT_TRUE(audience.needs_frame(1));
  show(audience, 1, Purpose::final);
  EXPECT_FALSE(audience.take(first.id));
  EXPECT_EQ(audience.take(second.id)->frame->header.codec, protocol::FrameCodec::png);
}

TEST_F(SessionTest, WhoPausesIsSentNothingAndResumesWithTheLatest) {
  ViewerSet& audience = session_.viewers();
  const Joined other = join();
  const Joined viewer = join();
  ASSERT_TRUE(session_.configure_stream({.paused = true}, viewer.id));
  show(audience, 4);
  EXPECT_FALSE(audience.take(viewer.id));
  ASSERT_TRUE(session_.configure_stream({.paused = false}, viewer.id));
  EXPECT_EQ(audience.take(viewer.id)->frame->header.render_id, 4u);
  session_.leave(other.id);
  ASSERT_TRUE(session_.configure_stream({.paused = true}, viewer.id));
  EXPECT_FALSE(audience.has_active_viewer());
}

TEST_F(SessionTest, FramesAreWantedWhileTheWindowIsOpen) {
  ViewerSet& audience = session_.viewers();
  EXPECT_FALSE(audience.can_accept_frame()) << "nobody is there";
  const Joined viewer = join();
  ASSERT_TRUE(session_.configure_stream({.max_fps = 240.0}, viewer.id));
  for (std::uint32_t id = 1; id <= stream::ack_window; ++id) {
    show(audience, id);
    ASSERT_TRUE(audience.take(viewer.id));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_FALSE(audience.can_accept_frame());
  EXPECT_TRUE(show(audience, 3).empty()) << "encoded for nobody";
  ASSERT_TRUE(audience.acknowledge(viewer.id, {.frame_seq = 1}));
  EXPECT_TRUE(audience.can_accept_frame());
  EXPECT_TRUE(audience.needs_frame(3));
  EXPECT_EQ(show(audience, 3).size(), 1u);
}

TEST_F(SessionTest, ADepartedViewerIsForgottenButCounted) {
  ViewerSet& audience = session_.viewers();
  Joined viewer = join();
  show(audience, 1);
  ASSERT_TRUE(audience.take(viewer.id));
  session_.leave(viewer.id);
  viewer.link.reset();
  show(audience, 2);
  EXPECT_FALSE(audience.take(viewer.id));
  EXPECT_EQ(audience.acknowledge(viewer.id, {.frame_seq = 1}).error().code, ErrorCode::not_ready);
  EXPECT_EQ(audience.totals().viewers, 0u);
  EXPECT_EQ(audience.totals().sent.frames, 1u);
}

TEST_F(SessionTest, StatsComeNoMoreOftenThanAskedFor) {
  const Joined viewer = join();
  ASSERT_TRUE(session_.viewers().subscribe(viewer.id, std::chrono::hours(1)));
  session_.viewers().publish_stats({.render_id = 4});
  EXPECT_TRUE(viewer.link->messages.empty()) << "it has not been sent a picture";
  show(session_.viewers(), 5);
  for (int i = 0; i < 3; ++i) session_.viewers().publish_stats({.render_id = 5});
  ASSERT_EQ(viewer.link->messages.size(), 1u);
  EXPECT_EQ(viewer.link->messages[0]["params"]["render_id"], 5);
  session_.viewers().publish_stats({.state = protocol::StreamPhase::idle});
  ASSERT_EQ(viewer.link->messages.size(), 2u) << "how it ends is always told";
  EXPECT_EQ(viewer.link->messages[1]["params"]["state"], "idle");
}

}  // namespace
}  // namespace heliograph::session
