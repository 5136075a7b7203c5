#include "jobs/job_queue.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <new>
#include <string>
#include <thread>

namespace heliograph::jobs {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// A queue that has nothing to render, and keeps jobs for a third of a second.
class IdleQueue : public testing::Test {
 protected:
  ~IdleQueue() override {
    queue_.stop();
    fs::remove_all(folder_);
  }

  std::string create() {
    protocol::JobCreate request;
    request.entries.resize(1);
    request.entries[0].scene = "fox";
    const auto job = queue_.create(request);
    EXPECT_TRUE(job);
    return job->job;
  }
  bool forgets(const std::string& id) {
    for (int i = 0; i < 2000 && queue_.status(id); ++i) std::this_thread::sleep_for(5ms);
    return !queue_.status(id);
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("queue" + std::to_string(getpid()));
  JobQueue queue_{{.folder = folder_, .keep_seconds = 0.3, .catalogue = [] {
                     const auto any = [](const std::string& name) -> protocol::Result<fs::path> {
                       return fs::path(name);
                     };
                     return QueueOptions::Catalogue{.scene = any, .environment = any};
                   }}};
};

TEST_F(IdleQueue, ForgetsAJobWhenItExpires) {
  const std::string first = create();
  const std::string second = create();
  ASSERT_TRUE(queue_.cancel(first));
  ASSERT_TRUE(queue_.cancel(second));
  queue_.start();
  EXPECT_TRUE(forgets(first));
  EXPECT_TRUE(forgets(second));
}

TEST_F(IdleQueue, AJobWhoseStartCannotBeToldEnds) {
  std::promise<protocol::JobInfo> ended;
  queue_.on_change([&](const protocol::JobInfo& job) {
    if (job.state == protocol::JobState::running) throw std::bad_alloc();
    if (job.state == protocol::JobState::failed) ended.set_value(job);
  });
  const std::string id = create();
  queue_.start();
  std::future<protocol::JobInfo> told = ended.get_future();
  const bool is_told = told.wait_for(30s) == std::future_status::ready;
  queue_.stop();
  ASSERT_TRUE(is_told) << "it runs without end";
  const protocol::JobInfo job = told.get();
  EXPECT_EQ(job.job, id);
  EXPECT_EQ(job.failures.size(), 1u);
}

TEST_F(IdleQueue, EndsWhileItWaitsForAJob) {
  queue_.start();
  std::this_thread::sleep_for(20ms);
  const auto begun = std::chrono::steady_clock::now();
  queue_.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 10s);
}

}  // namespace
}  // namespace heliograph::jobs
