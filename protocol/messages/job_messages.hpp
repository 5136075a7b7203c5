#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/enum_names.hpp"
#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/render_messages.hpp"

// Jobs: images and videos that the server renders beside its sessions, and keeps for a while.

namespace heliograph::protocol {

/// partial: some of the entries failed.
HELIOGRAPH_ENUM(JobState, queued, running, done, partial, failed, canceled)

inline constexpr std::size_t max_job_entries = 10000;
inline constexpr std::size_t max_job_name = 200;
inline constexpr std::size_t max_job_key = 200;
inline constexpr std::size_t max_webhook = 2000;
inline constexpr int most_job_priority = 100;
inline constexpr std::size_t max_listed_jobs = 1000;

struct JobCreate {
  static constexpr bool strict = true;

  std::vector<RenderRequest> entries;
  std::optional<std::string> name;
  std::int32_t priority = 0;
  std::optional<std::string> key;
  std::optional<std::string> webhook;

  static constexpr auto fields() {
    return std::tuple{
        field("entries", &JobCreate::entries, "What to render: as in a manifest.")
            .length(1, max_job_entries),
        field("name", &JobCreate::name, "A name for people.").length(1, max_job_name),
        field("priority", &JobCreate::priority,
              "Jobs of a higher priority begin first; of one priority, the older.")
            .range(-most_job_priority, most_job_priority)
            .or_default(),
        field("key", &JobCreate::key,
              "Idempotency key: a second request with it creates nothing and answers with the "
              "job of the first.")
            .length(1, max_job_key),
        field("webhook", &JobCreate::webhook,
              "Address that is told when the job has ended; its host must be allowed by the "
              "server.")
            .length(1, max_webhook),
    };
  }
  bool operator==(const JobCreate&) const = default;
};

struct JobChoice {
  std::string job;

  static constexpr auto fields() {
    return std::tuple{field("job", &JobChoice::job, "The job's id.").length(1, max_job_key)};
  }
  bool operator==(const JobChoice&) const = default;
};

struct JobFile {
  std::string name;
  std::string url;
  std::uint64_t bytes = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &JobFile::name, "The file's name in the job."),
        field("url", &JobFile::url, "Its path on this server."),
        field("bytes", &JobFile::bytes, "Its size.").unit("bytes"),
    };
  }
  bool operator==(const JobFile&) const = default;
};

struct JobFailure {
  std::uint32_t entry = 0;
  std::string scene;
  std::string reason;

  static constexpr auto fields() {
    return std::tuple{
        field("entry", &JobFailure::entry, "Number of the entry, from 1 on; 0: the whole job."),
        field("scene", &JobFailure::scene, "Its scene."),
        field("reason", &JobFailure::reason, "Why it failed."),
    };
  }
  bool operator==(const JobFailure&) const = default;
};

struct JobInfo {
  std::string job;
  std::optional<std::string> name;
  JobState state = JobState::queued;
  std::int32_t priority = 0;
  std::uint32_t entries = 0;
  std::uint32_t images_done = 0;
  std::uint32_t images = 0;
  std::uint32_t attempts = 0;
  double created = 0.0;
  std::optional<double> started;
  std::optional<double> ended;
  std::optional<double> expires;
  std::vector<JobFailure> failures;
  std::vector<JobFile> files;

  static constexpr auto fields() {
    return std::tuple{
        field("job", &JobInfo::job, "The job's id."),
        field("name", &JobInfo::name, "A name for people.").or_null(),
        field("state", &JobInfo::state,
              "queued, running, done, partial (some entries failed), failed or canceled."),
        field("priority", &JobInfo::priority, "Jobs of a higher priority begin first."),
        field("entries", &JobInfo::entries, "Number of entries."),
        field("images_done", &JobInfo::images_done, "Images that were rendered."),
        field("images", &JobInfo::images, "Number of images, as far as that is known."),
        field("attempts", &JobInfo::attempts,
              "How often it was begun: again after the server was killed."),
        field("created", &JobInfo::created, "When it was created, since 1970.").unit("seconds"),
        field("started", &JobInfo::started, "When it was begun.").unit("seconds").or_null(),
        field("ended", &JobInfo::ended, "When it ended.").unit("seconds").or_null(),
        field("expires", &JobInfo::expires, "When it is forgotten with its files.")
            .unit("seconds")
            .or_null(),
        field("failures", &JobInfo::failures, "The entries that failed."),
        field("files", &JobInfo::files,
              "The files that are complete; job.list and job.changed leave them out."),
    };
  }
  bool operator==(const JobInfo&) const = default;
};

struct JobListRequest {
  std::optional<JobState> state;
  std::uint32_t limit = 100;

  static constexpr auto fields() {
    return std::tuple{
        field("state", &JobListRequest::state, "Only jobs in this state."),
        field("limit", &JobListRequest::limit, "At most so many, the newest.")
            .range(1, max_listed_jobs)
            .or_default(),
    };
  }
  bool operator==(const JobListRequest&) const = default;
};

struct JobList {
  std::vector<JobInfo> jobs;
  std::uint64_t queued = 0;
  std::uint64_t bytes = 0;
  std::uint64_t quota = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("jobs", &JobList::jobs, "The jobs, the newest first."),
        field("queued", &JobList::queued, "Number of jobs that wait."),
        field("bytes", &JobList::bytes, "Size of all files.").unit("bytes"),
        field("quota", &JobList::quota, "Size of all files at most.").unit("bytes"),
    };
  }
  bool operator==(const JobList&) const = default;
};

}  // namespace heliograph::protocol
