#include "session/inspection/annotation_set.hpp"

#include <gtest/gtest.h>

namespace heliograph::session {
namespace {

/// A triangle in z = 0.
scene::Scene one_triangle() {
  scene::Scene scene;
  scene.nodes.resize(1);
  scene.meshes.resize(1);
  for (const glm::vec3 corner : {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) {
    shared::Vertex vertex{};
    vertex.position = corner;
    scene.meshes[0].vertices.push_back(vertex);
  }
  scene.meshes[0].indices = {0, 1, 2};
  scene.instances = {{0, 0}};
  return scene;
}

class AnnotationSetTest : public testing::Test {
 protected:
  protocol::Result<void> add(std::string text, std::optional<std::string> author = {},
                             std::optional<std::uint32_t> id = {}) {
    return set_.add(part_, scene_,
                    {.surface = {.node = 0, .triangle = 0, .barycentrics = {0.5f, 0.5f, 0}},
                     .text = std::move(text),
                     .author = std::move(author),
                     .id = id},
                    "Ada");
  }
  std::vector<protocol::Annotation> list(const ScenePart& part) const {
    return set_.list(part, scene_, scene::rest_pose(scene_)).annotations;
  }

  const scene::Scene scene_ = one_triangle();
  const ScenePart part_{.name = "triangle"};
  AnnotationSet set_;
};

TEST_F(AnnotationSetTest, HasTheViewersNameUnlessAnotherAuthorIsGiven) {
  ASSERT_TRUE(add("first"));
  ASSERT_TRUE(add("second", "Bob"));
  const auto listed = list(part_);
  ASSERT_EQ(listed.size(), 2u);
  EXPECT_EQ(listed[0].author, "Ada");
  EXPECT_EQ(listed[1].author, "Bob");
  EXPECT_EQ(listed[0].position, (protocol::Vec3{0.5f, 0, 0}));
  EXPECT_EQ(listed[0].normal, (protocol::Vec3{0, 0, 1}));
}

TEST_F(AnnotationSetTest, EditsAndRemovesThoseOfItsSceneOnly) {
  ASSERT_TRUE(add("first"));
  const ScenePart other{.name = "triangle", .part = 1};
  EXPECT_EQ(set_.edit(other, {.id = 1, .text = "x"}).error().path, "id");
  EXPECT_EQ(set_.remove(other, 1).error().path, "id");
  set_.clear(other);
  ASSERT_TRUE(set_.edit(part_, {.id = 1, .text = "changed"}));
  EXPECT_EQ(list(part_).at(0).text, "changed");
  EXPECT_TRUE(list(other).empty());
  ASSERT_TRUE(set_.remove(part_, 1));
  EXPECT_TRUE(list(part_).empty());
}

TEST_F(AnnotationSetTest, KeepsIdsUniqueAndHasALimit) {
  ASSERT_TRUE(add("first", {}, 7));
  EXPECT_EQ(add("again", {}, 7).error().code, protocol::ErrorCode::conflict);
  for (std::size_t i = 1; i < protocol::max_annotations; ++i) ASSERT_TRUE(add("more"));
  EXPECT_EQ(add("one too many").error().code, protocol::ErrorCode::full);
  EXPECT_EQ(list(part_).at(1).id, 8u);
}

}  // namespace
}  // namespace heliograph::session
