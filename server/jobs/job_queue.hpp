#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "jobs/job_store.hpp"
#include "jobs/render_process.hpp"
#include "protocol/messages/job_messages.hpp"
#include "protocol/result.hpp"

namespace heliograph::jobs {

struct QueueOptions {
  std::filesystem::path folder;               // of the database and the files
  std::uint64_t quota = 4ull << 30;           // bytes of all files
  std::uint64_t max_waiting = 10000;          // jobs
  double keep_seconds = 7 * 86400.0;          // after a job has ended
  std::vector<std::string> render_arguments;  // of every "heliograph render"
  std::vector<std::string> webhook_hosts;     // that may be told; empty: none
  std::string webhook_secret;                 // key of the signatures

  /// The files of scenes and environments by the names that clients use, as they are now.
  struct Catalogue {
    using Find = std::function<protocol::Result<std::filesystem::path>(const std::string&)>;
    Find scene;
    Find environment;
  };
  std::function<Catalogue()> catalogue;

  struct Delivery {
    std::string url;
    std::string body;
    std::string signature;  // "sha256=" and the HMAC of the body in hexadecimal digits
  };
  /// Posts a message; whether the answer was 2xx. Called on a thread of its own.
  std::function<bool(const Delivery&)> deliver;
};

/// Jobs from their creation to their expiry. One is rendered at a time, by a process of its own at
/// the lowest priority: what goes wrong in it is an error of the job. Everything that was accepted
/// is in the database; a job that was running when the server ended is begun again, and keeps the
/// files that were complete. Thread safe.
class JobQueue {
 public:
  /// @throws std::runtime_error if the folder or its database cannot be used
  explicit JobQueue(QueueOptions options);
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// Called after a change of a job, on any thread. Set before start().
  void on_change(std::function<void(const protocol::JobInfo&)> listener);
  /// Rendering pauses while `moving` says that the images of sessions move. Set before start().
  void pause_while(std::function<bool()> moving);
  void start();
  /// Ends the threads; the running job goes back into the queue.
  void stop();

  protocol::Result<protocol::JobInfo> create(const protocol::JobCreate& request);
  protocol::Result<protocol::JobList> list(const protocol::JobListRequest& request);
  protocol::Result<protocol::JobInfo> status(const std::string& id);
  protocol::Result<protocol::JobInfo> cancel(const std::string& id);
  /// A complete file of a job.
  protocol::Result<StoredFile> file(const std::string& id, const std::string& name);
  /// The complete files of a job.
  protocol::Result<std::vector<StoredFile>> files(const std::string& id);
  /// Where it is.
  std::filesystem::path path_of(const std::string& id, const StoredFile& file) const;

 private:
  protocol::Result<void> check(const protocol::JobCreate& request) const;
  void run();
  void run_webhooks();
  void wait_for_webhook(std::unique_lock<std::mutex>& lock);
  bool is_stopping();
  void begin_or_wait();
  bool wait(std::condition_variable& event, double seconds);
  void expire();
  void render(const BegunJob& job);
  void write_manifest(const BegunJob& job) const;
  std::vector<std::string> arguments() const;
  void follow(const BegunJob& job, RenderProcess& process, JobEnd& end);
  void take_event(const BegunJob& job, const std::string& line, JobEnd& end);
  void keep_file(const std::string& id, const std::string& name);
  std::string why_to_stop(const std::string& id);
  void put_back();
  void record_end();
  void announce(const std::string& id);
  std::filesystem::path folder_of(const std::string& id) const;

  const QueueOptions options_;
  // Of the queue's thread: the job that runs, until its end is recorded, and what that end is.
  std::optional<BegunJob> begun_;
  JobEnd end_;
  std::function<void(const protocol::JobInfo&)> listener_;
  std::function<bool()> sessions_move_ = [] { return false; };
  std::mutex mutex_;  // guards what follows
  JobStore store_;
  std::set<std::string> to_cancel_;
  bool stopping_ = false;
  std::condition_variable queue_event_;
  std::condition_variable webhook_event_;
  std::thread queue_thread_;
  std::thread webhook_thread_;
};

/// The default name of an entry's files, and whether a given one stays in the job's folder.
protocol::Result<std::string> checked_output(const protocol::RenderRequest& entry,
                                             std::size_t number, bool only_one);

}  // namespace heliograph::jobs
