#include "net/http/job_routes.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "net/download/byte_range.hpp"
#include "net/download/zip_archive.hpp"
#include "net/http/image_request.hpp"
#include "net/http/router.hpp"
#include "protocol/methods.hpp"

namespace heliograph::net {
namespace {

namespace methods = protocol::methods;
using protocol::Result;

/// The parts of "/api/v1/jobs/ID/files/NAME" or "/api/v1/jobs/ID/results.zip".
struct JobAddress {
  std::string id;
  std::string file;  // empty: the job itself, or
  bool archive = false;
};

/// Nothing for a path that is none of them.
std::optional<JobAddress> job_address(std::string_view path) {
  path.remove_prefix(jobs_path.size());
  if (path.empty() || path == "/") return JobAddress();
  path.remove_prefix(1);
  constexpr std::string_view files = "/files/";
  const std::size_t split = path.find('/');
  JobAddress address{.id = std::string(path.substr(0, split)), .file = {}};
  if (split == std::string_view::npos) return address;
  std::string_view rest = path.substr(split);
  address.archive = rest == "/results.zip";
  if (address.archive) return address;
  if (!rest.starts_with(files) || rest.size() == files.size()) return std::nullopt;
  rest.remove_prefix(files.size());
  // In a path a plus is a plus.
  std::string encoded;
  for (const char c : rest) encoded += c == '+' ? "%2B" : std::string(1, c);
  const auto decoded = parse_query(encoded + "=");
  if (decoded.empty()) return std::nullopt;
  address.file = decoded.begin()->first;
  return address;
}

template <class Method, class Response>
HttpResponse as_json(const Result<Response>& result, int status = 200) {
  if (!result) return error_response(result.error());
  HttpResponse response =
      json_response(protocol::MethodCodec<Method>::write_result(*result).text());
  response.status = status;
  return response;
}

HttpResponse create_job(const HttpRequest& request, jobs::JobQueue& jobs) {
  const auto json = protocol::RawJson::parse(request.body);
  if (!json) return text_response(400, "The body is no JSON: " + json.error().message);
  auto create = protocol::MethodCodec<methods::job_create>::read_params(*json);
  if (!create) return error_response(create.error());
  if (const std::string_view key = request.header("idempotency-key"); !key.empty()) {
    if (key.size() > protocol::max_job_key) {
      return text_response(400, "Idempotency-Key: is too long.");
    }
    create->key = std::string(key);
  }
  return as_json<methods::job_create>(jobs.create(*create), 202);
}

HttpResponse list_jobs(const HttpRequest& request, jobs::JobQueue& jobs) {
  if (const auto known = check_parameters(request, {"state", "limit"}); !known) {
    return error_response(known.error());
  }
  protocol::JobListRequest list;
  const auto limit = number_parameter(request, "limit", 1, protocol::max_listed_jobs);
  if (!limit) return error_response(limit.error());
  list.limit = limit->value_or(list.limit);
  if (const auto state = request.parameter("state")) {
    list.state = protocol::enum_value<protocol::JobState>(*state);
    if (!list.state) return text_response(400, "state: there is no " + *state);
  }
  return as_json<methods::job_list>(jobs.list(list));
}

std::string content_type_of(const std::string& name) {
  constexpr std::array types{
      std::pair{".png", "image/png"},        std::pair{".jpg", "image/jpeg"},
      std::pair{".webp", "image/webp"},      std::pair{".mp4", "video/mp4"},
      std::pair{".webm", "video/webm"},      std::pair{".exr", "image/x-exr"},
      std::pair{".npy", "application/x-npy"}};
  for (const auto& [extension, type] : types) {
    if (name.ends_with(extension)) return type;
  }
  return "application/octet-stream";
}

/// What a browser may keep, if it asks each time whether it is still the same.
HttpResponse downloadable(std::string content_type, Content content, std::uint64_t version) {
  const std::string etag = fmt::format("\"{:x}-{:x}\"", version, content.size());
  return {.content_type = std::move(content_type),
          .body = {},
          .headers = {{"ETag", etag}, {"Cache-Control", "private, no-cache"}},
          .content = std::move(content)};
}

HttpResponse job_file(const HttpRequest& request, const JobAddress& address, jobs::JobQueue& jobs) {
  const auto file = jobs.file(address.id, address.file);
  if (!file) return error_response(file.error());
  const std::filesystem::path path = jobs.path_of(address.id, *file);
  std::error_code gone;
  const std::uintmax_t bytes = std::filesystem::file_size(path, gone);
  if (gone) return text_response(404, "The file is gone.");
  Content content;
  content.add_file(path, bytes);
  return requested_part(request,
                        downloadable(content_type_of(file->name), std::move(content), file->crc));
}

/// The name of a job's archive, of characters that every file system takes.
std::string archive_name(const protocol::JobInfo& job) {
  std::string name;
  for (const char c : job.name.value_or("job-" + job.job)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    name += plain || c == '-' || c == '_' ? c : '_';
  }
  return name + ".zip";
}

/// The files that are complete by now.
HttpResponse job_archive(const HttpRequest& request, const JobAddress& address,
                         jobs::JobQueue& jobs) {
  const auto job = jobs.status(address.id);
  if (!job) return error_response(job.error());
  const auto files = jobs.files(address.id);
  if (!files) return error_response(files.error());
  if (files->empty()) return text_response(404, "The job has no files yet.");
  std::vector<ZipEntry> entries;
  std::uint64_t version = 0;
  for (const jobs::StoredFile& file : *files) {
    entries.push_back({.name = file.name,
                       .file = jobs.path_of(address.id, file),
                       .bytes = file.bytes,
                       .crc = file.crc});
    version = 31 * version + file.crc;
  }
  HttpResponse response =
      downloadable("application/zip", zip_archive(entries, job->created), version);
  response.headers.emplace_back("Content-Disposition",
                                "attachment; filename=\"" + archive_name(*job) + "\"");
  return requested_part(request, std::move(response));
}

HttpResponse only(std::string allowed) {
  HttpResponse response = text_response(405, "This address accepts only " + allowed + ".");
  response.headers.emplace_back("Allow", std::move(allowed));
  return response;
}

HttpResponse answer(const HttpRequest& request, const JobAddress& address, jobs::JobQueue& jobs) {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (address.id.empty()) {
    if (request.method == "POST") return create_job(request, jobs);
    return reads ? list_jobs(request, jobs) : only("GET and POST");
  }
  if (!address.file.empty()) return reads ? job_file(request, address, jobs) : only("GET");
  if (address.archive) return reads ? job_archive(request, address, jobs) : only("GET");
  if (request.method == "DELETE") return as_json<methods::job_cancel>(jobs.cancel(address.id));
  return reads ? as_json<methods::job_status>(jobs.status(address.id)) : only("GET and DELETE");
}

}  // namespace

bool is_job_path(std::string_view path) {
  return path == jobs_path || path.starts_with("/api/v1/jobs/");
}

HttpResponse answer_job(const HttpRequest& request, jobs::JobQueue* jobs, Role role) {
  if (!jobs) return text_response(404, "This server has no jobs: start it with --jobs FOLDER.");
  const std::optional<JobAddress> address = job_address(request.path);
  if (!address) return text_response(404, "Not found.");
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (!reads && role != Role::control) {
    return text_response(403, "This token is read-only and cannot change jobs.");
  }
  try {
    return answer(request, *address, *jobs);
  } catch (const std::runtime_error& failure) {
    // The disk is full, or fails: the sessions go on.
    spdlog::error("jobs: {}", failure.what());
    return text_response(503, "The database of jobs cannot be used; see the server's log.");
  }
}

}  // namespace heliograph::net
