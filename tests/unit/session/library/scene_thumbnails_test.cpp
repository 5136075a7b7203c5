#include "session/library/scene_thumbnails.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace heliograph::session {
namespace {

namespace fs = std::filesystem;

const SceneThumbnails::File an_image{0xff, 0xd8, 0xff};

/// A scene "box", and images that are there when the test has them rendered.
class SceneThumbnailsTest : public testing::TestWithParam<bool> {
 protected:
  SceneThumbnailsTest() : box_(folder_.write("scenes/box.glb")) {}

  fs::path kept_in() const { return GetParam() ? folder_.path() / "kept" : fs::path(); }
  std::ptrdiff_t files_kept() const {
    std::error_code error;
    return std::distance(fs::directory_iterator(folder_.path() / "kept", error),
                         fs::directory_iterator());
  }
  /// The error of get; ok: there is an image.
  bool has_image() { return static_cast<bool>(thumbnails_.get("box")); }
  fs::path image_file() const { return thumbnails_.file_of(*catalogue_.find("box")); }

  heliograph::test::TemporaryFolder folder_;
  fs::path box_;
  SceneCatalogue catalogue_{{folder_.path() / "scenes"}};
  SceneThumbnails::Rendered rendered_;
  SceneThumbnails thumbnails_{
      catalogue_, kept_in(),
      [this](const std::string&, SceneThumbnails::Rendered done) { rendered_ = std::move(done); }};
};

TEST_P(SceneThumbnailsTest, TheImageOfADeletedSceneIsGone) {
  EXPECT_FALSE(has_image());
  thumbnails_.render_next();
  rendered_(an_image);
  EXPECT_TRUE(has_image());
  thumbnails_.forget(image_file());
  EXPECT_EQ(files_kept(), 0);
  EXPECT_FALSE(has_image()) << "the file is still there: it is rendered again";
  EXPECT_TRUE(thumbnails_.has_work());
}

TEST_P(SceneThumbnailsTest, AnImageThatWaitsIsNotRenderedForADeletedScene) {
  EXPECT_FALSE(has_image());
  EXPECT_TRUE(thumbnails_.has_work());
  const fs::path file = image_file();
  fs::remove(box_);
  thumbnails_.forget(file);
  thumbnails_.render_next();
  EXPECT_FALSE(rendered_);
  EXPECT_FALSE(thumbnails_.has_work());
}

TEST_P(SceneThumbnailsTest, AFailureOfADeletedSceneIsForgotten) {
  EXPECT_FALSE(has_image());
  thumbnails_.render_next();
  rendered_(protocol::error::invalid("name", "cannot be loaded"));
  EXPECT_EQ(thumbnails_.get("box").error().code, protocol::ErrorCode::invalid_params);
  thumbnails_.forget(image_file());
  EXPECT_EQ(thumbnails_.get("box").error().code, protocol::ErrorCode::not_ready);
}

TEST_P(SceneThumbnailsTest, AnImageThatIsRenderedWhileItsSceneIsDeletedIsNotKept) {
  EXPECT_FALSE(has_image());
  thumbnails_.render_next();
  const fs::path file = image_file();
  const fs::file_time_type modified = fs::last_write_time(box_);
  fs::remove(box_);
  thumbnails_.forget(file);
  rendered_(an_image);
  EXPECT_EQ(files_kept(), 0);
  // The same file again would have the same image.
  folder_.write("scenes/box.glb");
  fs::last_write_time(box_, modified);
  ASSERT_EQ(image_file(), file);
  EXPECT_FALSE(has_image());
  thumbnails_.render_next();
  rendered_(an_image);
  EXPECT_TRUE(has_image());
}

INSTANTIATE_TEST_SUITE_P(OnDiskAndInMemory, SceneThumbnailsTest, testing::Bool());

}  // namespace
}  // namespace heliograph::session
