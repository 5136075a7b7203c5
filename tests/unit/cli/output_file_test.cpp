#include "cli/render/output/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace heliograph::cli {
namespace {

namespace fs = std::filesystem;

class OutputFiles : public testing::Test {
 protected:
  void SetUp() override {
    events_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    ASSERT_GE(inotify_add_watch(events_, folder_.c_str(), IN_CREATE), 0);
  }
  void TearDown() override { close(events_); }

  /// Names of the files that were created in the folder, at any time.
  std::set<std::string> created() const {
    std::set<std::string> names;
    alignas(inotify_event) std::array<char, 4096> bytes{};
    const ssize_t count = read(events_, bytes.data(), bytes.size());
    for (ssize_t at = 0; at < count;) {
      const auto* const event = reinterpret_cast<const inotify_event*>(bytes.data() + at);
      names.emplace(event->name);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
    }
    return names;
  }

  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
  int events_ = -1;
};

TEST_F(OutputFiles, TryingWhetherOneCanBeWrittenNeverGivesItsName) {
  EXPECT_TRUE(can_write(folder_ / "new.png"));
  EXPECT_FALSE(created().contains("new.png")) << "a kill would leave an empty file";
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(OutputFiles, TryingLeavesAnExistingOneAsItIs) {
  std::ofstream(folder_ / "old.png") << "bytes";
  EXPECT_TRUE(can_write(folder_ / "old.png"));
  EXPECT_EQ(fs::file_size(folder_ / "old.png"), 5u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(OutputFiles, MissingFoldersAreMade) {
  EXPECT_TRUE(can_write(folder_ / "a/b/new.png"));
  EXPECT_TRUE(fs::is_empty(folder_ / "a/b"));
}

TEST_F(OutputFiles, AFolderCannotBeWritten) {
  EXPECT_FALSE(can_write(folder_));
}

}  // namespace
}  // namespace heliograph::cli
