#include "jobs/job_store.hpp"

#include <nlohmann/json.hpp>
#include <random>
#include <string_view>

#include "protocol/json/codec.hpp"

namespace heliograph::jobs {

using protocol::JobInfo;
using protocol::JobState;

namespace {

constexpr const char* columns =
    "id, name, state, priority, entries, images_done, images, attempts, created, started, ended, "
    "expires";

/// 64 random bits: ids cannot be guessed.
std::string random_id() {
  std::random_device random;
  constexpr std::string_view digits = "0123456789abcdef";
  std::string id;
  for (int i = 0; i < 16; ++i) id += digits[random() % digits.size()];
  return id;
}

std::string_view name_of(JobState state) {
  return protocol::enum_name(state);
}

std::optional<double> optional_real(const Statement& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  return row.real(column);
}

/// Columns name, bytes, crc.
StoredFile read_file(const Statement& row) {
  return {.name = row.text(0),
          .bytes = static_cast<std::uint64_t>(row.integer(1)),
          .crc = static_cast<std::uint32_t>(row.integer(2))};
}

/// Before any scene is read: of each entry one camera.
std::int64_t known_images(const std::vector<protocol::RenderRequest>& entries) {
  std::int64_t images = 0;
  for (const protocol::RenderRequest& entry : entries) {
    images += std::int64_t{protocol::frame_count(entry)};
  }
  return images;
}

bool is_unreserved(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         std::string_view("-._~/").find(c) != std::string_view::npos;
}

/// The path of a job's file on the server.
std::string file_url(const std::string& id, const std::string& name) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string url = "/api/v1/jobs/" + id + "/files/";
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (is_unreserved(c)) {
      url += c;
    } else {
      url += {'%', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return url;
}

}  // namespace

JobStore::JobStore(const std::filesystem::path& file) : database_(file) {
  create_tables();
}

void JobStore::create_tables() {
  database_.execute(
      "CREATE TABLE IF NOT EXISTS jobs ("
      "  number INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, key TEXT UNIQUE,"
      "  name TEXT, request TEXT NOT NULL, entries INTEGER NOT NULL, priority INTEGER NOT NULL,"
      "  state TEXT NOT NULL, images_done INTEGER NOT NULL DEFAULT 0,"
      "  images INTEGER NOT NULL DEFAULT 0, attempts INTEGER NOT NULL DEFAULT 0,"
      "  created REAL NOT NULL, started REAL, ended REAL, expires REAL,"
      "  webhook TEXT, webhook_attempts INTEGER NOT NULL DEFAULT 0, webhook_due REAL);"
      "CREATE INDEX IF NOT EXISTS waiting ON jobs (state, priority DESC, number);"
      "CREATE TABLE IF NOT EXISTS failures ("
      "  job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE, entry INTEGER NOT NULL,"
      "  scene TEXT NOT NULL, reason TEXT NOT NULL);"
      "CREATE INDEX IF NOT EXISTS failures_of ON failures (job);"
      "CREATE TABLE IF NOT EXISTS files ("
      "  job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE, name TEXT NOT NULL,"
      "  bytes INTEGER NOT NULL, crc INTEGER, PRIMARY KEY (job, name));");
  // Earlier versions have stored no checksums.
  const bool checksums =
      database_.prepare("SELECT 1 FROM pragma_table_info('files') WHERE name = 'crc'").step();
  if (!checksums) database_.execute("ALTER TABLE files ADD COLUMN crc INTEGER");
}

void JobStore::recover(int most_attempts, double now, double expires) {
  Transaction transaction(database_);
  database_
      .prepare(
          "INSERT INTO failures SELECT id, 0, '', 'the server ended ' || attempts || ' times while "
          "it rendered this job' FROM jobs WHERE state = 'running' AND attempts >= ?1")
      .bind(1, std::int64_t{most_attempts})
      .run();
  database_
      .prepare(
          "UPDATE jobs SET state = 'failed', ended = ?2, expires = ?3, webhook_due = ?2 "
          "WHERE state = 'running' AND attempts >= ?1")
      .bind(1, std::int64_t{most_attempts})
      .bind(2, now)
      .bind(3, expires)
      .run();
  database_.execute("UPDATE jobs SET state = 'queued' WHERE state = 'running'");
  transaction.commit();
}

protocol::Result<std::string> JobStore::create(const protocol::JobCreate& request, double now) {
  const std::string text = protocol::encode(request).text();
  Transaction transaction(database_);
  if (request.key) {
    Statement same = database_.prepare("SELECT id, request FROM jobs WHERE key = ?1");
    if (same.bind(1, *request.key).step()) {
      if (same.text(1) == text) return same.text(0);
      return protocol::error::conflict("key", "belongs to a job with another request");
    }
  }
  const std::string id = random_id();
  database_
      .prepare(
          "INSERT INTO jobs (id, key, name, request, entries, priority, state, images, created, "
          "webhook) VALUES (?1, ?2, ?3, ?4, ?5, ?6, 'queued', ?7, ?8, ?9)")
      .bind(1, id)
      .bind(2, request.key)
      .bind(3, request.name)
      .bind(4, text)
      .bind(5, static_cast<std::int64_t>(request.entries.size()))
      .bind(6, std::int64_t{request.priority})
      .bind(7, known_images(request.entries))
      .bind(8, now)
      .bind(9, request.webhook)
      .run();
  transaction.commit();
  return id;
}

JobInfo JobStore::read_job(const Statement& row, bool with_files) {
  JobInfo job;
  job.job = row.text(0);
  if (!row.is_null(1)) job.name = row.text(1);
  job.state = protocol::enum_value<JobState>(row.text(2)).value_or(JobState::failed);
  job.priority = static_cast<std::int32_t>(row.integer(3));
  job.entries = static_cast<std::uint32_t>(row.integer(4));
  job.images_done = static_cast<std::uint32_t>(row.integer(5));
  job.images = static_cast<std::uint32_t>(row.integer(6));
  job.attempts = static_cast<std::uint32_t>(row.integer(7));
  job.created = row.real(8);
  job.started = optional_real(row, 9);
  job.ended = optional_real(row, 10);
  job.expires = optional_real(row, 11);
  job.failures = failures(job.job);
  if (!with_files) return job;
  for (const StoredFile& file : files(job.job)) {
    job.files.push_back(
        {.name = file.name, .url = file_url(job.job, file.name), .bytes = file.bytes});
  }
  return job;
}

std::vector<protocol::JobFailure> JobStore::failures(const std::string& id) {
  std::vector<protocol::JobFailure> failures;
  Statement rows =
      database_.prepare("SELECT entry, scene, reason FROM failures WHERE job = ?1 ORDER BY entry");
  rows.bind(1, id);
  while (rows.step()) {
    failures.push_back({.entry = static_cast<std::uint32_t>(rows.integer(0)),
                        .scene = rows.text(1),
                        .reason = rows.text(2)});
  }
  return failures;
}

std::vector<StoredFile> JobStore::files(const std::string& id) {
  std::vector<StoredFile> files;
  Statement rows =
      database_.prepare("SELECT name, bytes, crc FROM files WHERE job = ?1 ORDER BY name");
  rows.bind(1, id);
  while (rows.step()) files.push_back(read_file(rows));
  return files;
}

std::vector<std::pair<std::string, std::string>> JobStore::files_without_checksum() {
  std::vector<std::pair<std::string, std::string>> files;
  Statement rows = database_.prepare("SELECT job, name FROM files WHERE crc IS NULL");
  while (rows.step()) files.emplace_back(rows.text(0), rows.text(1));
  return files;
}

std::optional<JobInfo> JobStore::find(const std::string& id) {
  Statement row = database_.prepare("SELECT " + std::string(columns) + " FROM jobs WHERE id = ?1");
  if (!row.bind(1, id).step()) return std::nullopt;
  return read_job(row, true);
}

protocol::JobList JobStore::list(const protocol::JobListRequest& request) {
  protocol::JobList list;
  Statement rows =
      database_.prepare("SELECT " + std::string(columns) +
                        " FROM jobs WHERE ?1 IS NULL OR state = ?1 ORDER BY number DESC LIMIT ?2");
  if (request.state) {
    rows.bind(1, name_of(*request.state));
  } else {
    rows.bind_null(1);
  }
  rows.bind(2, std::int64_t{request.limit});
  while (rows.step()) list.jobs.push_back(read_job(rows, false));
  list.queued = count(JobState::queued);
  list.bytes = bytes();
  return list;
}

std::uint64_t JobStore::count(JobState state) {
  Statement row = database_.prepare("SELECT count(*) FROM jobs WHERE state = ?1");
  row.bind(1, name_of(state)).step();
  return static_cast<std::uint64_t>(row.integer(0));
}

std::uint64_t JobStore::bytes() {
  Statement row = database_.prepare("SELECT coalesce(sum(bytes), 0) FROM files");
  row.step();
  return static_cast<std::uint64_t>(row.integer(0));
}

std::optional<StoredFile> JobStore::file(const std::string& id, const std::string& name) {
  Statement row =
      database_.prepare("SELECT name, bytes, crc FROM files WHERE job = ?1 AND name = ?2");
  if (!row.bind(1, id).bind(2, name).step()) return std::nullopt;
  return read_file(row);
}

std::optional<BegunJob> JobStore::begin(double now) {
  Transaction transaction(database_);
  BegunJob job;
  std::string request;
  {
    Statement next = database_.prepare(
        "SELECT id, request FROM jobs WHERE state = 'queued' ORDER BY priority DESC, number "
        "LIMIT 1");
    if (!next.step()) return std::nullopt;
    job.id = next.text(0);
    request = next.text(1);
  }
  // It was written by encode(). Before the job runs: once it does, nothing can fail here.
  job.entries = protocol::decode<protocol::JobCreate>(*protocol::RawJson::parse(request))->entries;
  database_
      .prepare(
          "UPDATE jobs SET state = 'running', attempts = attempts + 1, started = ?2, "
          "images_done = 0 WHERE id = ?1")
      .bind(1, job.id)
      .bind(2, now)
      .run();
  transaction.commit();
  return job;
}

void JobStore::put_back(const std::string& id) {
  database_.prepare("UPDATE jobs SET state = 'queued' WHERE id = ?1 AND state = 'running'")
      .bind(1, id)
      .run();
}

void JobStore::set_progress(const std::string& id, std::uint32_t done, std::uint32_t images) {
  database_.prepare("UPDATE jobs SET images_done = ?2, images = ?3 WHERE id = ?1")
      .bind(1, id)
      .bind(2, std::int64_t{done})
      .bind(3, std::int64_t{images})
      .run();
}

void JobStore::add_file(const std::string& id, const StoredFile& file) {
  database_.prepare("INSERT OR REPLACE INTO files (job, name, bytes, crc) VALUES (?1, ?2, ?3, ?4)")
      .bind(1, id)
      .bind(2, file.name)
      .bind(3, static_cast<std::int64_t>(file.bytes))
      .bind(4, std::int64_t{file.crc})
      .run();
}

void JobStore::end(const std::string& id, const JobEnd& end, double now, double expires) {
  Transaction transaction(database_);
  for (const protocol::JobFailure& failure : end.failures) {
    database_.prepare("INSERT INTO failures (job, entry, scene, reason) VALUES (?1, ?2, ?3, ?4)")
        .bind(1, id)
        .bind(2, std::int64_t{failure.entry})
        .bind(3, failure.scene)
        .bind(4, failure.reason)
        .run();
  }
  database_
      .prepare(
          "UPDATE jobs SET state = ?2, ended = ?3, expires = ?4, webhook_due = ?3 WHERE id = ?1")
      .bind(1, id)
      .bind(2, name_of(end.state))
      .bind(3, now)
      .bind(4, expires)
      .run();
  transaction.commit();
}

std::optional<DueWebhook> JobStore::due_webhook(double now) {
  Statement row = database_.prepare(
      "SELECT id, webhook, webhook_attempts FROM jobs WHERE webhook IS NOT NULL AND "
      "webhook_due <= ?1 ORDER BY webhook_due LIMIT 1");
  if (!row.bind(1, now).step()) return std::nullopt;
  return DueWebhook{
      .id = row.text(0), .url = row.text(1), .attempts = static_cast<int>(row.integer(2))};
}

std::optional<double> JobStore::next_webhook() {
  Statement row = database_.prepare(
      "SELECT webhook_due FROM jobs WHERE webhook IS NOT NULL AND webhook_due IS NOT NULL "
      "ORDER BY webhook_due LIMIT 1");
  if (!row.step()) return std::nullopt;
  return row.real(0);
}

void JobStore::webhook_sent(const std::string& id, std::optional<double> again) {
  database_
      .prepare(
          "UPDATE jobs SET webhook_attempts = webhook_attempts + 1, webhook_due = ?2 "
          "WHERE id = ?1")
      .bind(1, id)
      .bind(2, again)
      .run();
}

std::vector<std::string> JobStore::expire(double now) {
  Transaction transaction(database_);
  std::vector<std::string> ids;
  {
    Statement rows = database_.prepare("SELECT id FROM jobs WHERE expires < ?1");
    rows.bind(1, now);
    while (rows.step()) ids.push_back(rows.text(0));
  }
  database_.prepare("DELETE FROM jobs WHERE expires < ?1").bind(1, now).run();
  transaction.commit();
  return ids;
}

std::optional<double> JobStore::next_expiry() {
  Statement row = database_.prepare("SELECT MIN(expires) FROM jobs");
  if (!row.step()) return std::nullopt;
  return optional_real(row, 0);
}

}  // namespace heliograph::jobs
