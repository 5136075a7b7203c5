#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/database.hpp"
#include "protocol/messages/job_messages.hpp"
#include "protocol/result.hpp"

namespace heliograph::jobs {

/// A job that was begun.
struct BegunJob {
  std::string id;
  std::vector<protocol::RenderRequest> entries;
};

/// A complete file of a job.
struct StoredFile {
  std::string name;
  std::uint64_t bytes = 0;
  std::uint32_t crc = 0;  // CRC-32
};

/// How a job ended.
struct JobEnd {
  protocol::JobState state = protocol::JobState::done;
  std::vector<protocol::JobFailure> failures;
};

/// A message to a client's own server that a job has ended.
struct DueWebhook {
  std::string id;
  std::string url;
  int attempts = 0;
};

/// The jobs in a database. Every function is one transaction. Times are seconds since 1970.
/// One thread at a time. @throws std::runtime_error where the database fails
class JobStore {
 public:
  explicit JobStore(const std::filesystem::path& file);

  /// Jobs that were running are queued again: the process that rendered them has ended.
  void recover(int most_attempts, double now, double expires);

  /// The new job's id; with a key that exists, that of its job.
  /// An error if the key belongs to another request.
  protocol::Result<std::string> create(const protocol::JobCreate& request, double now);
  std::optional<protocol::JobInfo> find(const std::string& id);
  protocol::JobList list(const protocol::JobListRequest& request);
  std::uint64_t count(protocol::JobState state);
  std::uint64_t bytes();
  std::optional<StoredFile> file(const std::string& id, const std::string& name);
  /// All of a job, by their names.
  std::vector<StoredFile> files(const std::string& id);
  /// Files that a server without checksums has stored, and their jobs.
  std::vector<std::pair<std::string, std::string>> files_without_checksum();

  /// The next job in the queue, which is running now.
  std::optional<BegunJob> begin(double now);
  /// Puts a running job back into the queue.
  void put_back(const std::string& id);
  void set_progress(const std::string& id, std::uint32_t done, std::uint32_t images);
  void add_file(const std::string& id, const StoredFile& file);
  void end(const std::string& id, const JobEnd& end, double now, double expires);

  std::optional<DueWebhook> due_webhook(double now);
  /// When the next one is due; empty: none is.
  std::optional<double> next_webhook();
  /// Delivered, or to be tried again at `again`.
  void webhook_sent(const std::string& id, std::optional<double> again);

  /// Forgets jobs that expired before `now`; gives their ids.
  std::vector<std::string> expire(double now);
  /// When the next one expires; empty: none does.
  std::optional<double> next_expiry();

 private:
  void create_tables();
  protocol::JobInfo read_job(const Statement& row, bool with_files);
  std::vector<protocol::JobFailure> failures(const std::string& id);

  Database database_;
};

}  // namespace heliograph::jobs
