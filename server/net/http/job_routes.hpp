#pragma once

#include <cstddef>
#include <string_view>

#include "jobs/job_queue.hpp"
#include "net/http/http_message.hpp"
#include "net/security/tokens.hpp"

namespace heliograph::net {

inline constexpr std::string_view jobs_path = "/api/v1/jobs";
/// Of a request that creates a job.
inline constexpr std::size_t max_job_bytes = 8 << 20;

/// Whether the path is that of the jobs, of a job or of its results.
bool is_job_path(std::string_view path);

/// POST creates a job, GET lists jobs, describes one or gives a file or all of them as a ZIP
/// archive, DELETE cancels a job.
/// `jobs`: null where the server has none.
HttpResponse answer_job(const HttpRequest& request, jobs::JobQueue* jobs, Role role);

}  // namespace heliograph::net
