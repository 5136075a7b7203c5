#include "gpu/pipelines/folder_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>

namespace heliograph::gpu {
namespace {

namespace fs = std::filesystem;

// The watch looks at the folder without being told every ten seconds.
constexpr std::chrono::seconds told_within{5};

class FolderWatchTest : public testing::Test {
 protected:
  FolderWatchTest() {
    std::string name = (fs::temp_directory_path() / "heliograph_watch_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    fs::create_directories(folder_ / "lib" / "deeper");
  }
  ~FolderWatchTest() override { fs::remove_all(folder_); }

  static void save(const fs::path& file) { std::ofstream(file) << "void main() {}"; }

  /// Whether the watch tells of what `change` does.
  template <typename Change>
  bool tells(const Change& change) {
    FolderWatch watch(folder_);
    auto told = std::async(std::launch::async, [&] { return watch.wait(); });
    EXPECT_EQ(told.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout)
        << "nothing has changed yet";
    change();
    const bool in_time = told.wait_for(told_within) == std::future_status::ready;
    if (!in_time) watch.stop();
    return told.get() && in_time;
  }

  fs::path folder_;
};

TEST_F(FolderWatchTest, ASavedFileIsTold) {
  EXPECT_TRUE(tells([&] { save(folder_ / "a.comp"); }));
  EXPECT_TRUE(tells([&] { save(folder_ / "lib" / "deeper" / "a.glsl"); }));
}

TEST_F(FolderWatchTest, AFileThatIsNewIsToldWhenItIsWritten) {
  FolderWatch watch(folder_);
  auto told = std::async(std::launch::async, [&] { return watch.wait(); });
  std::ofstream file(folder_ / "a.comp");
  EXPECT_EQ(told.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout)
      << "it is still empty";
  file.close();
  EXPECT_EQ(told.wait_for(told_within), std::future_status::ready);
  watch.stop();
}

TEST_F(FolderWatchTest, AFileThatIsMovedOverAnotherOrDeletedIsTold) {
  save(folder_ / "a.comp");
  save(folder_ / "saved");
  EXPECT_TRUE(tells([&] { fs::rename(folder_ / "saved", folder_ / "a.comp"); }));
  EXPECT_TRUE(tells([&] { fs::remove(folder_ / "a.comp"); }));
}

TEST_F(FolderWatchTest, FoldersMadeLaterAreWatched) {
  FolderWatch watch(folder_);
  fs::create_directory(folder_ / "post");
  EXPECT_TRUE(watch.wait());
  auto told = std::async(std::launch::async, [&] { return watch.wait(); });
  save(folder_ / "post" / "a.comp");
  EXPECT_EQ(told.wait_for(told_within), std::future_status::ready);
  watch.stop();
}

TEST_F(FolderWatchTest, StopEndsEveryWait) {
  FolderWatch watch(folder_);
  auto waiting = std::async(std::launch::async, [&] { return watch.wait(); });
  watch.stop();
  ASSERT_EQ(waiting.wait_for(told_within), std::future_status::ready);
  EXPECT_FALSE(waiting.get());
  EXPECT_FALSE(watch.wait());
}

}  // namespace
}  // namespace heliograph::gpu
