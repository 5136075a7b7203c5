// How the queue renders one job.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "jobs/checksum.hpp"
#include "jobs/job_queue.hpp"
#include "jobs/pauses.hpp"
#include "protocol/json/codec.hpp"

namespace heliograph::jobs {

using protocol::JobFailure;
using protocol::JobState;
namespace fs = std::filesystem;

namespace {

constexpr int poll_ms = 100;
constexpr auto grace = std::chrono::seconds(5);              // after SIGTERM
constexpr auto progress_interval = std::chrono::seconds(1);  // of notifications

using Clock = std::chrono::steady_clock;

/// The last line, without "heliograph: ".
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t begin = text.rfind('\n');
  if (begin != std::string::npos) text.erase(0, begin + 1);
  constexpr std::string_view program = "heliograph: ";
  if (text.starts_with(program)) text.erase(0, program.size());
  return text;
}

/// Clients know scenes by their names only.
std::string without_path(std::string text, const std::string& path, const std::string& name) {
  if (path.empty()) return text;
  for (std::size_t at = 0; (at = text.find(path, at)) != std::string::npos; at += name.size()) {
    text.replace(at, path.size(), name);
  }
  return text;
}

/// The state that the exit code of "heliograph render" stands for.
JobState state_of(int exit_code) {
  if (exit_code == 0) return JobState::done;
  return exit_code == 3 ? JobState::partial : JobState::failed;
}

/// The folder that must exist before the files are rendered: up to the first placeholder.
fs::path fixed_folder(const std::string& output) {
  return fs::path(output.substr(0, std::min(output.find_first_of("{%"), output.size())))
      .parent_path();
}

}  // namespace

void JobQueue::write_manifest(const BegunJob& job) const {
  const fs::path folder = folder_of(job.id);
  fs::create_directories(folder / "files");
  const QueueOptions::Catalogue catalogue = options_.catalogue();
  nlohmann::json entries = nlohmann::json::array();
  for (std::size_t i = 0; i < job.entries.size(); ++i) {
    protocol::RenderRequest entry = job.entries[i];
    // A scene that was removed meanwhile fails alone.
    if (const auto file = catalogue.scene(entry.scene)) entry.scene = file->string();
    if (!entry.environment.empty()) {
      if (const auto file = catalogue.environment(entry.environment)) {
        entry.environment = file->string();
      }
    }
    entry.output = *checked_output(entry, i + 1, job.entries.size() == 1);
    fs::create_directories(folder / "files" / fixed_folder(entry.output));
    nlohmann::json written = protocol::encode(entry).value();
    // The default of a job is the server's, which is among the arguments.
    if (entry.environment.empty()) written.erase("environment");
    entries.push_back(std::move(written));
  }
  std::ofstream file(folder / "manifest.json", std::ios::binary);
  file << protocol::RawJson(std::move(entries)).text();
  file.close();
  if (!file) throw std::runtime_error("cannot write the job's manifest");
}

std::vector<std::string> JobQueue::arguments() const {
  std::vector<std::string> arguments{"render",   "--manifest",    "../manifest.json",
                                     "--resume", "--progress",    "json",
                                     "--report", "../report.json"};
  arguments.insert(arguments.end(), options_.render_arguments.begin(),
                   options_.render_arguments.end());
  return arguments;
}

void JobQueue::render(const BegunJob& job) {
  JobEnd end;
  bool interrupted = false;
  try {
    announce(job.id);
    write_manifest(job);
    RenderProcess process(arguments(), folder_of(job.id) / "files");
    follow(job, process, end);
    interrupted = is_stopping() && process.exit_code() != 0;
    if (end.state != JobState::canceled && end.failures.empty()) {
      end.state = state_of(process.exit_code());
    } else if (end.state != JobState::canceled) {
      end.state = process.exit_code() == 3 ? JobState::partial : JobState::failed;
    }
    if (end.state == JobState::failed && end.failures.empty()) {
      const int code = process.exit_code();
      const std::string reason = code < 0
                                     ? "the renderer was ended by signal " + std::to_string(-code)
                                     : last_line(process.errors());
      end.failures.push_back({.entry = 0, .scene = {}, .reason = reason});
    }
  } catch (const fs::filesystem_error& failure) {
    end = {.state = JobState::failed,
           .failures = {{.entry = 0, .scene = {}, .reason = failure.code().message()}}};
  } catch (const std::exception& failure) {
    end = {.state = JobState::failed,
           .failures = {{.entry = 0, .scene = {}, .reason = failure.what()}}};
  }
  if (interrupted) return put_back();
  end_ = std::move(end);
  record_end();
}

/// Where it throws, the next server begins the job again all the same: it was running.
void JobQueue::put_back() {
  const BegunJob job = *std::exchange(begun_, std::nullopt);
  const std::lock_guard lock(mutex_);
  store_.put_back(job.id);
}

/// Empty: go on.
std::string JobQueue::why_to_stop(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (stopping_) return "the server ends";
  if (to_cancel_.contains(id)) return "canceled";
  if (store_.bytes() <= options_.quota) return {};
  return "the files of jobs have reached their quota of " + std::to_string(options_.quota) +
         " bytes";
}

void JobQueue::follow(const BegunJob& job, RenderProcess& process, JobEnd& end) {
  std::string stop_reason;
  Clock::time_point deadline = Clock::time_point::max();
  Clock::time_point next_notice = Clock::now();
  Pauses pauses(Clock::now());
  while (!process.ended()) {
    const auto lines = process.read_lines(poll_ms);
    for (const std::string& line : lines) take_event(job, line, end);
    if (!lines.empty() && Clock::now() >= next_notice) {
      announce(job.id);
      next_notice = Clock::now() + progress_interval;
    }
    if (stop_reason.empty() && !(stop_reason = why_to_stop(job.id)).empty()) {
      process.interrupt();
      deadline = Clock::now() + grace;
    }
    process.set_paused(stop_reason.empty() && pauses.update(Clock::now(), sessions_move_()));
    if (Clock::now() >= deadline) process.kill();
  }
  const std::lock_guard lock(mutex_);
  if (to_cancel_.contains(job.id)) {
    end.state = JobState::canceled;
  } else if (!stop_reason.empty() && !stopping_) {
    end.failures.push_back({.entry = 0, .scene = {}, .reason = stop_reason});
  }
}

void JobQueue::take_event(const BegunJob& job, const std::string& line, JobEnd& end) {
  const auto parsed = protocol::RawJson::parse(line);
  if (!parsed || !parsed->value().is_object()) return;
  const nlohmann::json& event = parsed->value();
  const std::string kind = event.value("event", "");
  if (kind == "image") {
    const std::lock_guard lock(mutex_);
    store_.set_progress(job.id, event.value("done", 0u), event.value("total", 0u));
  } else if (kind == "written" || kind == "kept") {
    keep_file(job.id, event.value("file", ""));
  } else if (kind == "failed") {
    const std::size_t entry = event.value("entry", std::size_t{0});
    const bool known = entry >= 1 && entry <= job.entries.size();
    const std::string name = known ? job.entries[entry - 1].scene : "";
    const std::string reason =
        without_path(event.value("reason", ""), event.value("scene", ""), name);
    end.failures.push_back(
        {.entry = static_cast<std::uint32_t>(entry), .scene = name, .reason = reason});
  }
}

void JobQueue::keep_file(const std::string& id, const std::string& name) {
  const fs::path file = folder_of(id) / "files" / name;
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  const auto crc = crc32_of(file);
  if (error || !crc) return;
  const std::lock_guard lock(mutex_);
  store_.add_file(id, {.name = name, .bytes = bytes, .crc = *crc});
}

}  // namespace heliograph::jobs
