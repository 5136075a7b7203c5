#include "session/library/upload_store.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace heliograph::session {
namespace {

namespace fs = std::filesystem;

/// A store in a folder, in which the tests put files as if they had been accepted.
class UploadStoreTest : public testing::Test {
 protected:
  bool has(const std::string& file) const { return fs::exists(folder_.path() / file); }

  heliograph::test::TemporaryFolder folder_;
  UploadStore store_{{.folder = folder_.path(), .max_bytes = 100, .quota = 100}};
};

TEST_F(UploadStoreTest, RemovesAnUploadOfItsKindOnly) {
  folder_.write("scenes/box.glb");
  folder_.write("environments/box.exr");
  folder_.write("images/box.webp");
  EXPECT_TRUE(store_.remove(UploadKind::environment, "box"));
  EXPECT_FALSE(has("environments/box.exr"));
  EXPECT_TRUE(has("scenes/box.glb"));
  EXPECT_TRUE(store_.remove(UploadKind::image, "box"));
  EXPECT_FALSE(has("images/box.webp"));
  EXPECT_TRUE(store_.remove(UploadKind::scene, "box"));
  EXPECT_FALSE(has("scenes/box.glb"));
}

TEST_F(UploadStoreTest, RemovesAllFormatsSoThatNoneAppearsInThePlaceOfAnother) {
  for (const char* file : {"sky.hdr", "sky.exr"})
    folder_.write("environments/" + std::string(file));
  EXPECT_TRUE(store_.remove(UploadKind::environment, "sky"));
  EXPECT_TRUE(fs::is_empty(store_.environments()));
  for (const char* extension : {".png", ".jpg", ".jpeg", ".webp", ".ktx2"}) {
    folder_.write("images/bricks" + std::string(extension));
  }
  folder_.write("images/bricks_2.png");
  EXPECT_TRUE(store_.remove(UploadKind::image, "bricks"));
  EXPECT_TRUE(has("images/bricks_2.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(store_.images()), fs::directory_iterator()), 1);
}

TEST_F(UploadStoreTest, TellsOfAnUploadThatItHasNot) {
  const auto removed = store_.remove(UploadKind::scene, "box");
  ASSERT_FALSE(removed);
  EXPECT_EQ(removed.error().code, protocol::ErrorCode::not_found);
  EXPECT_EQ(removed.error().path, "name");
}

TEST_F(UploadStoreTest, NamesOfRemovalsCannotLeaveTheFolders) {
  folder_.write("outside.glb");
  folder_.write("scenes/more/box.glb");
  for (const char* name :
       {"../outside", "more/box", "", ".", "..", "%2e%2e%2foutside", "a.glb", "-x"}) {
    const auto removed = store_.remove(UploadKind::scene, name);
    ASSERT_FALSE(removed) << name;
    EXPECT_EQ(removed.error().code, protocol::ErrorCode::invalid_params) << name;
  }
  EXPECT_TRUE(has("outside.glb"));
  EXPECT_TRUE(has("scenes/more/box.glb"));
}

TEST_F(UploadStoreTest, BytesOfARemovedFileCountNoLonger) {
  folder_.write("scenes/box.glb", std::string(60, 'x'));
  const auto full = store_.begin(UploadKind::scene, "other", 50);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, protocol::ErrorCode::full);
  EXPECT_TRUE(store_.remove(UploadKind::scene, "box"));
  EXPECT_TRUE(store_.begin(UploadKind::scene, "other", 50));
}

TEST_F(UploadStoreTest, TellsUploadsFromFilesThatOthersPutThere) {
  folder_.write("scenes/box.glb");
  folder_.write("scenes/by_hand.gltf");
  folder_.write("scenes/more/box.glb");
  const SceneCatalogue catalogue({store_.scenes()});
  for (const auto& [name, uploaded] :
       {std::pair("box", true), std::pair("by_hand", false), std::pair("more/box", false)}) {
    const auto entry = catalogue.find(name);
    ASSERT_TRUE(entry) << name;
    EXPECT_EQ(is_upload(*entry), uploaded) << name;
  }
}

}  // namespace
}  // namespace heliograph::session
