#include "jobs/job_queue.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace heliograph::jobs {

using protocol::JobInfo;
using protocol::JobState;
using protocol::Result;
namespace fs = std::filesystem;

namespace {

constexpr int most_attempts = 5;
constexpr double pause_after_failure = 5.0;     // of the database, seconds
constexpr double longest_expiry_wait = 3600.0;  // the clock may be set

double now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

bool has_ended(JobState state) {
  return state != JobState::queued && state != JobState::running;
}

fs::path prepared(const fs::path& folder) {
  fs::create_directories(folder / "jobs");
  return folder / "jobs.sqlite";
}

protocol::Error no_such_job(const std::string& id) {
  return protocol::error::not_found("job", "there is no job " + id);
}

/// The host of "https://host:443/path".
std::string_view host_of(std::string_view url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string_view::npos) return {};
  url.remove_prefix(scheme + 3);
  url = url.substr(0, std::min(url.find_first_of("/?#"), url.size()));
  if (url.find('@') != std::string_view::npos) return {};
  const std::size_t colon = url.rfind(':');
  const bool port = colon != std::string_view::npos && url.find(']', colon) == url.npos;
  return port ? url.substr(0, colon) : url;
}

/// An error of an entry with the path of its member: "entries[2].scene".
protocol::Error of_entry(const protocol::Error& error, std::size_t index, const char* member) {
  return protocol::error::make(error.code, "entries[" + std::to_string(index) + "]." + member,
                               error.reason, error.limit);
}

}  // namespace

JobQueue::JobQueue(QueueOptions options)
    : options_(std::move(options)), store_(prepared(options_.folder)) {
  const double time = now();
  store_.recover(most_attempts, time, time + options_.keep_seconds);
  for (const auto& [id, name] : store_.files_without_checksum()) keep_file(id, name);
}

JobQueue::~JobQueue() {
  stop();
}

void JobQueue::on_change(std::function<void(const JobInfo&)> listener) {
  listener_ = std::move(listener);
}

void JobQueue::pause_while(std::function<bool()> moving) {
  sessions_move_ = std::move(moving);
}

void JobQueue::start() {
  queue_thread_ = std::thread([this] { run(); });
  webhook_thread_ = std::thread([this] { run_webhooks(); });
}

void JobQueue::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  queue_event_.notify_all();
  webhook_event_.notify_all();
  if (queue_thread_.joinable()) queue_thread_.join();
  if (webhook_thread_.joinable()) webhook_thread_.join();
}

Result<void> JobQueue::check(const protocol::JobCreate& request) const {
  const QueueOptions::Catalogue catalogue = options_.catalogue();
  for (std::size_t i = 0; i < request.entries.size(); ++i) {
    const protocol::RenderRequest& entry = request.entries[i];
    const auto scene = catalogue.scene(entry.scene);
    if (!scene) return of_entry(scene.error(), i, "scene");
    if (!entry.environment.empty()) {
      const auto environment = catalogue.environment(entry.environment);
      if (!environment) return of_entry(environment.error(), i, "environment");
    }
    const auto output = checked_output(entry, i + 1, request.entries.size() == 1);
    if (!output) return of_entry(output.error(), i, "output");
  }
  if (!request.webhook) return {};
  const std::string_view host = host_of(*request.webhook);
  if (!host.empty() &&
      std::ranges::find(options_.webhook_hosts, host) != options_.webhook_hosts.end())
    return {};
  return protocol::error::invalid("webhook", "its host is not allowed; see --webhook-host");
}

Result<JobInfo> JobQueue::create(const protocol::JobCreate& request) {
  if (const auto valid = check(request); !valid) return valid.error();
  JobInfo job;
  {
    const std::lock_guard lock(mutex_);
    if (store_.count(JobState::queued) >= options_.max_waiting) {
      return protocol::error::full("too many jobs wait", std::to_string(options_.max_waiting));
    }
    if (store_.bytes() >= options_.quota) {
      return protocol::error::full("the files of jobs have reached their quota",
                                   std::to_string(options_.quota) + " bytes");
    }
    const auto id = store_.create(request, now());
    if (!id) return id.error();
    queue_event_.notify_all();  // it is rendered, even if what follows fails
    job = *store_.find(*id);
  }
  if (listener_) listener_(job);
  return job;
}

Result<protocol::JobList> JobQueue::list(const protocol::JobListRequest& request) {
  const std::lock_guard lock(mutex_);
  protocol::JobList list = store_.list(request);
  list.quota = options_.quota;
  return list;
}

Result<JobInfo> JobQueue::status(const std::string& id) {
  const std::lock_guard lock(mutex_);
  auto job = store_.find(id);
  if (!job) return no_such_job(id);
  return *std::move(job);
}

Result<JobInfo> JobQueue::cancel(const std::string& id) {
  JobInfo job;
  {
    const std::lock_guard lock(mutex_);
    const auto found = store_.find(id);
    if (!found) return no_such_job(id);
    if (found->state == JobState::running) to_cancel_.insert(id);
    if (found->state == JobState::queued) {
      const double time = now();
      store_.end(id, {.state = JobState::canceled, .failures = {}}, time,
                 time + options_.keep_seconds);
      queue_event_.notify_all();
      webhook_event_.notify_all();
    }
    job = *store_.find(id);
  }
  if (has_ended(job.state) && listener_) listener_(job);
  return job;
}

Result<StoredFile> JobQueue::file(const std::string& id, const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (auto file = store_.file(id, name)) return *std::move(file);
  if (!store_.find(id)) return no_such_job(id);
  return protocol::error::not_found("name", "the job has no such file");
}

Result<std::vector<StoredFile>> JobQueue::files(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (!store_.find(id)) return no_such_job(id);
  return store_.files(id);
}

fs::path JobQueue::path_of(const std::string& id, const StoredFile& file) const {
  return folder_of(id) / "files" / file.name;
}

fs::path JobQueue::folder_of(const std::string& id) const {
  return options_.folder / "jobs" / id;
}

bool JobQueue::wait(std::condition_variable& event, double seconds) {
  std::unique_lock lock(mutex_);
  if (!stopping_) event.wait_for(lock, std::chrono::duration<double>(seconds));
  return !stopping_;
}

bool JobQueue::is_stopping() {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

/// Begins the next job; where there is none, waits for a change or until a job expires. Looking and
/// waiting are one step under the lock: a job that is created between them would wait for the next
/// change.
void JobQueue::begin_or_wait() {
  std::unique_lock lock(mutex_);
  if (stopping_) return;
  // What is recorded of a job that an exception leaves, as where memory is exhausted. Made before
  // the job begins: from then on it has an end.
  end_ = {.state = JobState::failed,
          .failures = {{.entry = 0, .scene = {}, .reason = "the server failed; see its log"}}};
  begun_ = store_.begin(now());
  if (begun_) return;
  if (const std::optional<double> expiry = store_.next_expiry()) {
    const double seconds = std::clamp(*expiry - now(), 0.0, longest_expiry_wait);
    queue_event_.wait_for(lock, std::chrono::duration<double>(seconds));
  } else {
    queue_event_.wait(lock);
  }
}

void JobQueue::run() {
  while (true) {
    try {
      record_end();
      expire();
      begin_or_wait();
      if (begun_) {
        render(*begun_);
      } else if (is_stopping()) {
        return;
      }
    } catch (const std::exception& failure) {
      spdlog::error("jobs: {}", failure.what());
      if (!wait(queue_event_, pause_after_failure)) return;
    }
  }
}

void JobQueue::expire() {
  std::vector<std::string> expired;
  {
    const std::lock_guard lock(mutex_);
    expired = store_.expire(now());
  }
  std::error_code ignored;
  for (const std::string& id : expired) fs::remove_all(folder_of(id), ignored);
}

/// Where it throws, as while the disk is full, the end is recorded later.
void JobQueue::record_end() {
  if (!begun_) return;
  const std::string id = begun_->id;
  {
    const std::lock_guard lock(mutex_);
    const double time = now();
    store_.end(id, end_, time, time + options_.keep_seconds);
    to_cancel_.erase(id);
  }
  begun_.reset();
  webhook_event_.notify_all();
  announce(id);
}

void JobQueue::announce(const std::string& id) {
  std::optional<JobInfo> job;
  {
    const std::lock_guard lock(mutex_);
    job = store_.find(id);
  }
  if (!job || !listener_) return;
  job->files.clear();
  listener_(*job);
}

}  // namespace heliograph::jobs
