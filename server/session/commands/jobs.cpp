#include "jobs/job_queue.hpp"
#include "session/commands/commands.hpp"

namespace heliograph::session {

namespace methods = protocol::methods;

namespace {

/// Adds a command about jobs: `command(queue, request)` gives a Result<Response>.
template <class Method, class Command>
void add_job_command(protocol::Dispatcher& dispatcher, SessionHost& host, Command command) {
  dispatcher.add<Method>([&host, command](const typename Method::Params& request,
                                          const protocol::CallContext&,
                                          protocol::Completion<typename Method::Result> done) {
    if (!host.jobs()) {
      return done(protocol::error::not_ready("this server has no jobs: start it with --jobs"));
    }
    done(command(*host.jobs(), request));
  });
}

}  // namespace

void add_job_commands(protocol::Dispatcher& dispatcher, SessionHost& host) {
  add_job_command<methods::job_create>(
      dispatcher, host, [](jobs::JobQueue& queue, const protocol::JobCreate& request) {
        return queue.create(request);
      });
  add_job_command<methods::job_list>(
      dispatcher, host, [](jobs::JobQueue& queue, const protocol::JobListRequest& request) {
        return queue.list(request);
      });
  add_job_command<methods::job_status>(
      dispatcher, host, [](jobs::JobQueue& queue, const protocol::JobChoice& request) {
        return queue.status(request.job);
      });
  add_job_command<methods::job_cancel>(
      dispatcher, host, [](jobs::JobQueue& queue, const protocol::JobChoice& request) {
        return queue.cancel(request.job);
      });
}

}  // namespace heliograph::session
