#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "session/session_registry.hpp"
#include "tests/unit/session/recording_link.hpp"

// What viewers of one scene share beyond their sessions: pointers, and cameras of other viewers.

namespace heliograph::session {
namespace {

using nlohmann::json;
using protocol::ErrorCode;
using protocol::Vec3;
using test::RecordingLink;

class SessionCompanyTest : public testing::Test {
 protected:
  SessionCompanyTest()
      : registry_(
            {}, sized(""),
            [](SessionOptions options, PixelShare pixels) {
              return std::make_shared<Session>(std::move(options), std::make_shared<WakeEvent>(),
                                               std::move(pixels));
            },
            [](const Session&) {}) {
    scene_->bounds.include(glm::vec3(-1.0f));
    scene_->bounds.include(glm::vec3(1.0f));
    show_scene();
  }

  void show_scene() {
    registry_.main()->scene().show({.name = "box", .scene = scene_, .resources = nullptr}, "");
  }

  static SessionOptions sized(std::string name) {
    SessionOptions options;
    options.name = std::move(name);
    options.width = 20;
    options.height = 10;
    return options;
  }
  std::string enter(const std::string& session = "main") {
    const auto link = std::make_shared<RecordingLink>();
    const auto id = registry_.enter(session, link);
    EXPECT_TRUE(id) << id.error().message;
    links_[*id] = link;
    return *id;
  }
  std::string enter_detached() {
    std::string id = enter();
    const auto view = registry_.detach(id, sized(""));
    EXPECT_TRUE(view) << view.error().message;
    return id;
  }
  /// Parameters of the newest notification of this name; null if there is none.
  json heard(const std::string& viewer, const std::string& method) {
    const auto& messages = links_.at(viewer)->messages;
    for (auto it = messages.rbegin(); it != messages.rend(); ++it) {
      if (it->at("method") == method) return it->at("params");
    }
    return nullptr;
  }
  Vec3 move(const std::string& viewer, Vec3 eye) {
    const auto moved = registry_.session_of_viewer(viewer)->camera().set({.eye = eye}, viewer);
    EXPECT_TRUE(moved) << moved.error().message;
    return moved->eye;
  }
  Vec3 eye_of(const std::string& viewer) {
    return registry_.session_of_viewer(viewer)->camera().get()->eye;
  }

  /// Lets each viewer but the first follow another one, so that all have the camera of the first.
  void follow_first(const std::vector<std::string>& viewers, std::mt19937& random) {
    registry_.stop_following(viewers.front());
    for (std::size_t i = 1; i < viewers.size(); ++i) {
      // Those before follow the first already: no circle closes.
      const auto followed = registry_.follow(viewers[i], viewers[random() % i]);
      EXPECT_TRUE(followed) << followed.error().message;
    }
  }

  std::map<std::string, std::shared_ptr<RecordingLink>> links_;
  std::shared_ptr<scene::Scene> scene_ = std::make_shared<scene::Scene>();
  SessionRegistry registry_;
};

TEST_F(SessionCompanyTest, APointerIsShownToAllWhoSeeTheScene) {
  const std::string ada = enter();
  const std::string bob = enter();
  const std::string detached = enter_detached();
  ASSERT_TRUE(registry_.create(sized("other")));
  const std::string elsewhere = enter("other");
  registry_.main()->viewers().set_name(ada, "Ada");
  ASSERT_TRUE(registry_.point(ada, Vec3{1, 2, 3}));
  const json shown = {{"viewer", ada}, {"name", "Ada"}, {"position", {1.0, 2.0, 3.0}}};
  EXPECT_EQ(heard(bob, "pointer.changed"), shown);
  EXPECT_EQ(heard(detached, "pointer.changed"), shown);
  EXPECT_EQ(heard(ada, "pointer.changed"), nullptr);
  EXPECT_EQ(heard(elsewhere, "pointer.changed"), nullptr);
  EXPECT_EQ(links_.at(bob)->keys.back(), "pointer.changed " + ada) << "the newest replaces others";

  ASSERT_TRUE(registry_.point(detached, Vec3{0, 0, 0}));
  EXPECT_EQ(heard(ada, "pointer.changed")["viewer"], detached);
  EXPECT_EQ(registry_.point("v99", {}).error().code, ErrorCode::not_ready);
}

TEST_F(SessionCompanyTest, APointerIsHiddenOnceWhenItsViewerLeaves) {
  const std::string ada = enter();
  const std::string bob = enter();
  registry_.leave(enter());
  EXPECT_EQ(heard(bob, "pointer.changed"), nullptr) << "it had no pointer";
  ASSERT_TRUE(registry_.point(ada, Vec3{1, 2, 3}));
  ASSERT_TRUE(registry_.point(ada, {}));
  EXPECT_EQ(heard(bob, "pointer.changed")["position"], nullptr);
  links_.at(bob)->messages.clear();
  ASSERT_TRUE(registry_.point(ada, {}));
  EXPECT_EQ(heard(bob, "pointer.changed"), nullptr) << "it was hidden already";
  ASSERT_TRUE(registry_.point(ada, Vec3{1, 2, 3}));
  registry_.leave(ada);
  EXPECT_EQ(heard(bob, "pointer.changed")["viewer"], ada);
  EXPECT_EQ(heard(bob, "pointer.changed")["position"], nullptr);
}

TEST_F(SessionCompanyTest, AViewerTakesOverTheCameraOfAnotherUntilItStops) {
  const std::string ada = enter_detached();
  const std::string bob = enter_detached();
  move(ada, {5, 0, 0});
  ASSERT_TRUE(registry_.follow(bob, ada));
  EXPECT_EQ(eye_of(bob), (Vec3{5, 0, 0})) << "at once";
  EXPECT_EQ(heard(bob, "camera.changed")["by"], ada);
  move(ada, {0, 6, 1});
  EXPECT_EQ(eye_of(bob), (Vec3{0, 6, 1}));
  EXPECT_EQ(heard(bob, "camera.changed")["camera"]["eye"], json({0.0, 6.0, 1.0}));
  registry_.stop_following(bob);
  move(ada, {7, 0, 0});
  EXPECT_EQ(eye_of(bob), (Vec3{0, 6, 1}));
  EXPECT_EQ(heard(bob, "viewer.unfollowed"), nullptr) << "it knows";
}

TEST_F(SessionCompanyTest, TheSharedCameraCanBeFollowedAndFollowersOfFollowersMove) {
  const std::string ada = enter();
  const std::string bob = enter_detached();
  const std::string eve = enter_detached();
  ASSERT_TRUE(registry_.follow(bob, ada));
  ASSERT_TRUE(registry_.follow(eve, bob));
  move(ada, {0, 0, 9});
  EXPECT_EQ(eye_of(bob), (Vec3{0, 0, 9}));
  EXPECT_EQ(eye_of(eve), (Vec3{0, 0, 9}));
  move(bob, {3, 0, 0});
  EXPECT_EQ(eye_of(eve), (Vec3{3, 0, 0}));
  EXPECT_EQ(eye_of(ada), (Vec3{0, 0, 9}));
}

TEST_F(SessionCompanyTest, FollowingIsRefusedWhereItCannotBe) {
  const std::string ada = enter_detached();
  const std::string bob = enter_detached();
  const std::string eve = enter_detached();
  const std::string shared = enter();
  EXPECT_EQ(registry_.follow(shared, ada).error().code, ErrorCode::conflict);
  EXPECT_EQ(registry_.follow(ada, ada).error().code, ErrorCode::not_found);
  EXPECT_EQ(registry_.follow(ada, "v99").error().path, "viewer");
  EXPECT_EQ(registry_.follow("v99", ada).error().code, ErrorCode::not_ready);
  ASSERT_TRUE(registry_.create(sized("other")));
  EXPECT_EQ(registry_.follow(ada, enter("other")).error().code, ErrorCode::not_found);
  ASSERT_TRUE(registry_.follow(bob, ada));
  ASSERT_TRUE(registry_.follow(eve, bob));
  EXPECT_EQ(registry_.follow(ada, eve).error().code, ErrorCode::conflict) << "a circle";
  registry_.stop_following(bob);
  ASSERT_TRUE(registry_.follow(ada, eve));
  move(bob, {2, 0, 0});
  EXPECT_EQ(eye_of(ada), (Vec3{2, 0, 0}));
}

TEST_F(SessionCompanyTest, AFollowerHasTheCameraThatTheSameSceneBringsAgain) {
  const std::string ada = enter();
  const std::string bob = enter_detached();
  const std::string eve = enter_detached();
  const Vec3 first = eye_of(ada);
  ASSERT_TRUE(registry_.follow(bob, ada));
  move(ada, {5, 0, 0});
  move(eve, {0, 7, 1});
  show_scene();
  EXPECT_EQ(eye_of(ada), first);
  EXPECT_EQ(eye_of(bob), first);
  EXPECT_EQ(heard(bob, "camera.changed")["camera"]["eye"].get<Vec3>(), first);
  EXPECT_EQ(eye_of(eve), (Vec3{0, 7, 1})) << "it follows no one";
}

TEST_F(SessionCompanyTest, AFollowerThatBeganDuringAFirstViewHasTheCameraWhenItEnds) {
  const std::string ada = enter();
  const std::string bob = enter_detached();
  move(ada, {5, 0, 0});
  const Vec3 before = eye_of(bob);
  registry_.main()->scene().show_first_view(std::make_shared<scene::Scene>(), nullptr, ada);
  ASSERT_TRUE(registry_.follow(bob, ada));
  EXPECT_EQ(eye_of(bob), before) << "it does not see the scene that ada sees";
  registry_.main()->scene().end_first_view();
  EXPECT_EQ(eye_of(bob), (Vec3{5, 0, 0}));
}

// The directions of following change while cameras move on other threads, so that with the thread
// sanitizer also locks that are held over several sessions would be told of.
TEST_F(SessionCompanyTest, FollowersEndAtTheirLeadersCameraWhateverChangesMeanwhile) {
  constexpr int rounds = 8;
  constexpr int threads = 3;
  constexpr int moves = 60;
  std::vector<std::string> viewers;
  for (int i = 0; i < 5; ++i) viewers.push_back(enter_detached());
  std::mt19937 random(1);
  for (int round = 0; round < rounds; ++round) {
    std::shuffle(viewers.begin(), viewers.end(), random);
    for (const auto& [viewer, link] : links_) link->messages.clear();
    const std::string leader = viewers.front();
    registry_.stop_following(leader);
    std::atomic<int> moving = threads;
    std::vector<std::thread> movers;
    for (int thread = 0; thread < threads; ++thread) {
      movers.emplace_back([this, leader, thread, &moving] {
        for (int i = 1; i <= moves; ++i) {
          move(leader, {static_cast<float>(2 + i), static_cast<float>(2 + thread), 3.0f});
        }
        --moving;
      });
    }
    do {
      std::shuffle(viewers.begin() + 1, viewers.end(), random);
      follow_first(viewers, random);
    } while (moving > 0);
    for (std::thread& mover : movers) mover.join();
    const Vec3 eye = eye_of(leader);
    for (auto viewer = viewers.begin() + 1; viewer != viewers.end(); ++viewer) {
      EXPECT_EQ(eye_of(*viewer), eye) << round;
      EXPECT_EQ(heard(*viewer, "camera.changed")["camera"]["eye"].get<Vec3>(), eye)
          << "the newest is told last";
    }
  }
}

TEST_F(SessionCompanyTest, FollowingEndsWhenEitherViewerLeavesItsSession) {
  const std::string ada = enter_detached();
  const std::string bob = enter_detached();
  ASSERT_TRUE(registry_.follow(bob, ada));
  ASSERT_TRUE(registry_.move(ada, "main"));
  EXPECT_EQ(heard(bob, "viewer.unfollowed"), json({{"viewer", ada}}));
  links_.at(bob)->messages.clear();
  move(ada, {4, 0, 0});
  EXPECT_NE(eye_of(bob), (Vec3{4, 0, 0}));

  ASSERT_TRUE(registry_.follow(bob, ada));
  ASSERT_TRUE(registry_.move(bob, "main"));
  move(ada, {5, 0, 0});
  registry_.leave(ada);
  EXPECT_EQ(heard(bob, "viewer.unfollowed"), nullptr) << "it followed no one any more";

  ASSERT_TRUE(registry_.detach(bob, sized("")));
  const std::string eve = enter();
  ASSERT_TRUE(registry_.follow(bob, eve));
  registry_.leave(eve);
  EXPECT_EQ(heard(bob, "viewer.unfollowed"), json({{"viewer", eve}}));
}

TEST_F(SessionCompanyTest, AllEndsWithTheSessionThatTheyFollow) {
  ASSERT_TRUE(registry_.create(sized("review")));
  const std::string ada = enter("review");
  const std::string bob = enter("review");
  ASSERT_TRUE(registry_.detach(ada, sized("")));
  ASSERT_TRUE(registry_.detach(bob, sized("")));
  ASSERT_TRUE(registry_.follow(bob, ada));
  ASSERT_TRUE(registry_.point(ada, Vec3{1, 2, 3}));
  ASSERT_TRUE(registry_.close("review", "the end"));
  EXPECT_EQ(registry_.count(), 1u);
  EXPECT_EQ(links_.at(ada)->close_reason, "the end");
  EXPECT_EQ(links_.at(bob)->close_reason, "the end");
}

TEST_F(SessionCompanyTest, ThoseWhoStayHearThatAViewWithItsOwnCameraHasEnded) {
  const std::string ada = enter_detached();
  const std::string bob = enter();
  registry_.main()->viewers().start(bob);
  links_.at(bob)->messages.clear();
  registry_.leave(ada);
  EXPECT_NE(heard(bob, "session.changed"), nullptr);
}

}  // namespace
}  // namespace heliograph::session
