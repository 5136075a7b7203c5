#include "jobs/job_store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace heliograph::jobs {
namespace {

using protocol::JobState;

class Store : public testing::Test {
 protected:
  Store() { std::filesystem::create_directories(folder_); }
  ~Store() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file() const { return folder_ / "jobs.sqlite"; }

  static protocol::JobCreate request(int priority = 0) {
    protocol::JobCreate create;
    create.entries.resize(2);
    create.entries[0].scene = "fox";
    create.entries[1].scene = "helmet";
    create.priority = priority;
    return create;
  }

 private:
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("jobs" + std::to_string(getpid()));
};

TEST_F(Store, JobsBeginByPriorityThenByAge) {
  JobStore store(file());
  const std::string first = *store.create(request(), 1.0);
  const std::string urgent = *store.create(request(5), 2.0);
  const std::string second = *store.create(request(), 3.0);
  for (const std::string& id : {urgent, first, second}) {
    const auto job = store.begin(4.0);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->id, id);
    EXPECT_EQ(job->entries.at(1).scene, "helmet");
    EXPECT_EQ(store.find(id)->state, JobState::running);
  }
  EXPECT_FALSE(store.begin(5.0));
}

TEST_F(Store, ImagesOfTurntablesAndClipsAreKnownWhileTheyWait) {
  JobStore store(file());
  protocol::JobCreate create = request();
  create.entries[0].turntable = 36;
  const std::string id = *store.create(create, 1.0);
  EXPECT_EQ(store.find(id)->images, 37u);
  EXPECT_EQ(store.find(id)->entries, 2u);
}

TEST_F(Store, WhatWasRunningIsQueuedAgainWithItsFiles) {
  std::string id;
  {
    JobStore store(file());
    id = *store.create(request(), 1.0);
    store.begin(2.0);
    store.add_file(id, {.name = "a.png", .bytes = 70, .crc = 7});
  }
  for (std::uint32_t attempts = 1; attempts < 5; ++attempts) {
    JobStore store(file());
    store.recover(5, 3.0, 4.0);
    EXPECT_EQ(store.find(id)->state, JobState::queued);
    EXPECT_EQ(store.find(id)->attempts, attempts);
    EXPECT_EQ(store.begin(3.0)->id, id);
  }
  JobStore store(file());
  store.recover(5, 3.0, 4.0);
  const auto given_up = store.find(id);
  EXPECT_EQ(given_up->state, JobState::failed);
  EXPECT_NE(given_up->failures.at(0).reason.find("5 times"), std::string::npos);
  EXPECT_EQ(given_up->files.at(0).bytes, 70u);
  EXPECT_EQ(given_up->expires, 4.0);
}

TEST_F(Store, AKeyBelongsToOneRequest) {
  JobStore store(file());
  protocol::JobCreate create = request();
  create.key = "order 7";
  const std::string id = *store.create(create, 1.0);
  EXPECT_EQ(*store.create(create, 2.0), id);
  create.entries[0].width = 64;
  EXPECT_EQ(store.create(create, 3.0).error().code, protocol::ErrorCode::conflict);
  EXPECT_EQ(store.count(JobState::queued), 1u);
}

TEST_F(Store, AnEndIsToldUntilItIsTaken) {
  JobStore store(file());
  protocol::JobCreate create = request();
  create.webhook = "https://example.org/done";
  const std::string id = *store.create(create, 1.0);
  store.begin(1.0);
  EXPECT_FALSE(store.due_webhook(2.0));
  EXPECT_FALSE(store.next_webhook());
  store.end(id, {.state = JobState::done, .failures = {}}, 3.0, 100.0);
  ASSERT_TRUE(store.due_webhook(3.0));
  EXPECT_EQ(store.due_webhook(3.0)->url, "https://example.org/done");
  store.webhook_sent(id, 8.0);
  EXPECT_FALSE(store.due_webhook(7.9));
  EXPECT_EQ(store.next_webhook(), 8.0);
  EXPECT_EQ(store.due_webhook(8.0)->attempts, 1);
  store.webhook_sent(id, std::nullopt);
  EXPECT_FALSE(store.due_webhook(1e9));
  EXPECT_FALSE(store.next_webhook());
}

TEST_F(Store, ExpiredJobsAreForgottenWithTheirFiles) {
  JobStore store(file());
  const std::string id = *store.create(request(), 1.0);
  const std::string waiting = *store.create(request(), 1.0);
  store.begin(1.0);
  store.add_file(id, {.name = "a b.png", .bytes = 30, .crc = 1});
  store.add_file(id, {.name = "a b.png", .bytes = 40, .crc = 0xfedcba98});
  EXPECT_EQ(store.bytes(), 40u);
  EXPECT_EQ(store.find(id)->files.at(0).url, "/api/v1/jobs/" + id + "/files/a%20b.png");
  EXPECT_EQ(store.file(id, "a b.png")->crc, 0xfedcba98);
  EXPECT_EQ(store.files(id).at(0).bytes, 40u);
  const protocol::JobFailure failure{.entry = 2, .scene = "helmet", .reason = "is broken"};
  store.end(id, {.state = JobState::partial, .failures = {failure}}, 2.0, 10.0);
  EXPECT_EQ(store.find(id)->failures.at(0), failure);
  EXPECT_EQ(store.next_expiry(), 10.0);
  EXPECT_TRUE(store.expire(10.0).empty());
  EXPECT_EQ(store.expire(10.1), std::vector{id});
  EXPECT_FALSE(store.next_expiry());
  EXPECT_FALSE(store.find(id));
  EXPECT_TRUE(store.find(waiting)) << "jobs that wait do not expire";
  EXPECT_EQ(store.bytes(), 0u);
}

TEST_F(Store, AFolderThatIsNoneIsTold) {
  EXPECT_THROW(JobStore("/no/such/folder/jobs.sqlite"), std::runtime_error);
}

}  // namespace
}  // namespace heliograph::jobs
