#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "cli/commands.hpp"
#include "cli/log.hpp"
#include "cli/render/output/output_file.hpp"
#include "cli/render/render_scene.hpp"
#include "cli/render/stopped_time.hpp"

namespace heliograph::cli {
namespace {

constexpr int some_failed = 3;
constexpr int interrupted = 130;  // as shells say after SIGINT

std::atomic<bool> canceled = false;

/// The first SIGINT or SIGTERM ends the command after what is complete, the second at once.
void cancel_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { canceled = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

ProgressKind progress_kind(const RenderOptions& options) {
  if (options.progress == "terminal") return ProgressKind::terminal;
  if (options.progress == "json") return ProgressKind::json;
  if (options.progress == "none" || options.timings) return ProgressKind::none;
  if (isatty(STDERR_FILENO) == 1) return ProgressKind::terminal;
  return options.manifest.empty() ? ProgressKind::none : ProgressKind::json;
}

std::size_t count_images(const std::vector<RenderTask>& tasks) {
  std::size_t images = 0;
  for (const RenderTask& task : tasks) images += expected_images(task);
  return images;
}

/// Whether the entry is complete, or failed alone; false where the command ends.
bool render_entry(RenderContext& context, const RenderTask& task) {
  try {
    if (canceled) throw RenderCanceled();
    render_task(context, task);
    return true;
  } catch (const RenderCanceled&) {
    context.report.cancel(task.number, task.request.scene);
    return false;
  } catch (const std::exception& failure) {
    context.report.fail(task.number, task.request.scene, failure.what());
    return true;
  }
}

void write_report(const RenderOptions& options, const RenderContext& context) {
  if (options.report.empty()) return;
  nlohmann::json report = context.report.json();
  if (!options.shard.empty()) report["shard"] = options.shard;
  if (context.engine) {
    report["device"] = context.engine->device().name;
    report["tracer"] = protocol::enum_name(context.engine->tracer());
  }
  const std::string text = protocol::RawJson(std::move(report)).text() + "\n";
  write_whole(options.report, {text.begin(), text.end()});
}

}  // namespace

int run(const RenderOptions& options) {
  set_up_log({.level = "warning"});  // standard output may be an image
  const std::vector<RenderTask> tasks = make_tasks(options);
  if (!options.report.empty() && !can_write(options.report)) {
    throw std::runtime_error("--report: cannot write " + options.report);
  }
  cancel_on_signals();
  count_stopped_time();
  RenderReport report(progress_kind(options), tasks.size(), count_images(tasks));
  RenderContext context{.options = options, .report = report, .canceled = canceled};
  bool complete = true;
  for (const RenderTask& task : tasks) complete = render_entry(context, task) && complete;
  report.end();
  write_report(options, context);
  if (!complete) return interrupted;
  if (report.failed() == 0) return 0;
  if (tasks.size() > 1) {
    std::fprintf(stderr, "heliograph: %zu of %zu scenes failed\n", report.failed(), tasks.size());
  }
  return report.failed() == tasks.size() ? 1 : some_failed;
}

}  // namespace heliograph::cli
