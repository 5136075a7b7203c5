#pragma once

#include <memory>

#include "cli/options.hpp"
#include "jobs/job_queue.hpp"
#include "session/session_host.hpp"

namespace heliograph::cli {

/// The queue of jobs that the options ask for, or null. Jobs are rendered with the server's
/// settings, device and limits, and find scenes and environments as its sessions do.
/// @throws std::runtime_error if its folder cannot be used
std::unique_ptr<jobs::JobQueue> make_job_queue(const ServeOptions& options,
                                               const session::HostOptions& hosting);

}  // namespace heliograph::cli
