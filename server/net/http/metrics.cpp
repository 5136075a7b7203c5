#include "net/http/metrics.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <utility>

#include "net/security/resource_limits.hpp"

namespace heliograph::net {
namespace {

using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

/// A label's value as the format wants it between quotes.
std::string escaped(std::string_view value) {
  std::string text;
  for (const char c : value) {
    if (c == '\\' || c == '"') text += '\\';
    c == '\n' ? text += "\\n" : text += c;
  }
  return text;
}

std::string label_text(Labels labels, std::string_view bound = {}) {
  std::string text;
  const auto add = [&](std::string_view name, std::string_view value) {
    text += fmt::format("{}{}=\"{}\"", text.empty() ? "{" : ",", name, escaped(value));
  };
  for (const auto& [name, value] : labels) add(name, value);
  if (!bound.empty()) add("le", bound);
  return text.empty() ? text : text + "}";
}

class Page {
 public:
  void counter(std::string_view name, std::string_view help, double value) {
    describe(name, help, "counter");
    sample(name, {}, value);
  }
  void gauge(std::string_view name, std::string_view help, double value) {
    describe(name, help, "gauge");
    sample(name, {}, value);
  }
  void histogram(std::string_view name, std::string_view help, const stream::Histogram& values) {
    describe(name, help, "histogram");
    buckets(name, {}, values);
  }
  void describe(std::string_view name, std::string_view help, std::string_view type) {
    text_ += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
  }
  void sample(std::string_view name, Labels labels, double value) {
    line(name, label_text(labels), value);
  }
  void buckets(std::string_view name, Labels labels, const stream::Histogram& values) {
    const std::string bucket = fmt::format("{}_bucket", name);
    for (std::size_t i = 0; i < values.bounds.size(); ++i) {
      line(bucket, label_text(labels, fmt::format("{}", values.bounds[i])),
           static_cast<double>(values.up_to(i)));
    }
    line(bucket, label_text(labels, "+Inf"), static_cast<double>(values.count()));
    line(fmt::format("{}_sum", name), label_text(labels), values.sum());
    line(fmt::format("{}_count", name), label_text(labels), static_cast<double>(values.count()));
  }
  std::string text() && { return std::move(text_); }

 private:
  void line(std::string_view name, std::string_view labels, double value) {
    text_ += fmt::format("{}{} {}\n", name, labels, value);
  }

  std::string text_;
};

double resident_bytes() {
  std::ifstream statistics("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  statistics >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double open_files() {
  std::error_code error;
  const std::filesystem::directory_iterator folder("/proc/self/fd", error);
  return error ? 0.0 : static_cast<double>(std::distance(begin(folder), end(folder)));
}

void add_process(Page& page, const MetricsInput& input) {
  const std::chrono::duration<double> uptime = std::chrono::steady_clock::now() - input.started;
  page.describe("heliograph_build_info", "1, with the version and what it runs on.", "gauge");
  const render::Engine& first = input.host.devices().engine(0);
  page.sample("heliograph_build_info",
              {{"version", HELIOGRAPH_VERSION},
               {"device", first.device().name},
               {"tracer", protocol::enum_name(first.tracer())}},
              1);
  page.gauge("heliograph_uptime_seconds", "Time since the server started.", uptime.count());
  page.gauge("heliograph_ready", "1 if the server accepts new viewers.",
             input.host.ready() && !input.draining ? 1 : 0);
  page.gauge("heliograph_draining", "1 while the server shuts down.", input.draining ? 1 : 0);
  page.gauge("heliograph_resident_memory_bytes", "Memory in use.", resident_bytes());
  const ResourceLimits limits = read_resource_limits("/sys/fs/cgroup");
  if (limits.memory_bytes) {
    page.gauge("heliograph_memory_limit_bytes", "Memory that the container may use.",
               *limits.memory_bytes);
  }
  if (limits.processors) {
    page.gauge("heliograph_cpu_limit_cores", "Processors that the container may use.",
               *limits.processors);
  }
  page.counter("process_cpu_seconds_total", "Processor time used.", processor_seconds());
  page.gauge("process_open_fds", "Open files and sockets.", open_files());
}

void add_streams(Page& page, const session::SessionHost& host) {
  const session::ViewerTotals totals = host.sessions().totals();
  const std::chrono::duration<double> round_trip = totals.mean_round_trip;
  const auto number = [](auto value) { return static_cast<double>(value); };
  page.gauge("heliograph_viewers", "Connected viewers.", number(totals.viewers));
  page.gauge("heliograph_viewers_limit", "Most viewers of all sessions.",
             number(host.sessions().limits().viewers));
  const session::SessionRegistry& sessions = host.sessions();
  page.gauge("heliograph_sessions", "Sessions, main included.", number(sessions.count()));
  page.gauge("heliograph_sessions_limit", "Most sessions.", number(sessions.limits().sessions));
  page.counter("heliograph_sessions_opened_total", "Sessions opened since the start.",
               number(sessions.opened()));
  page.gauge("heliograph_session_pixels", "Pixels of the frames of all sessions.",
             number(sessions.pixels_used()));
  page.gauge("heliograph_session_pixels_limit", "Most of them.", number(sessions.limits().pixels));
  page.counter("heliograph_frames_sent_total", "Frames sent to viewers.",
               number(totals.sent.frames));
  page.counter("heliograph_sent_bytes_total", "Bytes of the frames sent to viewers.",
               number(totals.sent.bytes));
  page.counter("heliograph_frames_dropped_total",
               "Frames that a newer one replaced before they were sent.",
               number(totals.sent.dropped));
  page.counter("heliograph_frames_acknowledged_total", "Frames that viewers have confirmed.",
               number(totals.sent.acknowledged));
  page.gauge("heliograph_frames_pending", "Frames that cannot be sent yet.",
             number(totals.waiting));
  page.gauge("heliograph_frames_in_flight", "Frames sent and not yet confirmed.",
             number(totals.in_flight));
  page.gauge("heliograph_round_trip_seconds",
             "Mean of the viewers' smoothed times from sending a frame to its confirmation.",
             round_trip.count());
  page.histogram("heliograph_ack_round_trip_seconds",
                 "From sending a frame to its confirmation, less what the viewer held it.",
                 totals.sent.round_trips);
  page.gauge("heliograph_goodput_bytes_per_second",
             "What all viewers' connections together take when busy, estimated from confirmations; "
             "not what is sent.",
             totals.goodput);
}

void add_devices(Page& page, const session::RenderDevices& devices) {
  const auto each = [&](std::string_view name, std::string_view help, std::string_view type,
                        const auto& value) {
    page.describe(name, help, type);
    for (std::size_t i = 0; i < devices.count(); ++i) {
      page.sample(name, {{"device", std::to_string(i)}},
                  static_cast<double>(value(devices.loop(i))));
    }
  };
  using Loop = const session::RenderLoop&;
  page.describe("heliograph_device_info", "1, with the name of each device.", "gauge");
  for (std::size_t i = 0; i < devices.count(); ++i) {
    const render::DeviceInfo info = devices.engine(i).device();
    page.sample("heliograph_device_info",
                {{"device", std::to_string(i)},
                 {"name", info.name},
                 {"driver", info.driver},
                 {"tracer", protocol::enum_name(devices.engine(i).tracer())}},
                1);
  }
  each("heliograph_device_losses_total", "Losses of the graphics device.", "counter",
       [](Loop loop) { return loop.device_losses(); });
  each("heliograph_device_ready", "1 if the device works, 0 while it is lost.", "gauge",
       [](Loop loop) { return loop.device_ready() ? 1 : 0; });
  each("heliograph_device_sessions", "Sessions that the device renders.", "gauge",
       [](Loop loop) { return loop.load().sessions; });
  each("heliograph_device_frames_total", "Frames that the device has rendered.", "counter",
       [](Loop loop) { return loop.device_totals().frames; });
  page.describe("heliograph_device_submissions_total",
                "Times that commands were given to the device; none while nothing changes.",
                "counter");
  for (std::size_t i = 0; i < devices.count(); ++i) {
    page.sample("heliograph_device_submissions_total", {{"device", std::to_string(i)}},
                static_cast<double>(devices.engine(i).submissions()));
  }
  each("heliograph_device_render_seconds_total", "Time for which the device rendered.", "counter",
       [](Loop loop) { return loop.device_totals().seconds; });
  page.describe("heliograph_device_free_memory_bytes",
                "The device's own memory that is free, where it tells.", "gauge");
  for (std::size_t i = 0; i < devices.count(); ++i) {
    const auto free_memory = devices.loop(i).load().free_memory;
    if (!free_memory) continue;
    page.sample("heliograph_device_free_memory_bytes", {{"device", std::to_string(i)}},
                static_cast<double>(*free_memory));
  }
}

void add_rendering(Page& page, const session::SessionHost& host) {
  const session::RenderTotals render = host.render_totals();
  page.histogram("heliograph_render_seconds", "Rendering, each frame.", render.frames);
  page.histogram("heliograph_encode_seconds", "Encoding on the host, or taking what is encoded.",
                 render.encodings);
  page.describe("heliograph_frames_encoded_total", "By what encoded them.", "counter");
  for (const auto by : {protocol::PassKind::device, protocol::PassKind::host}) {
    const auto known = render.encoded_by.find(by);
    page.sample("heliograph_frames_encoded_total", {{"kind", protocol::enum_name(by)}},
                known == render.encoded_by.end() ? 0.0 : static_cast<double>(known->second));
  }
  page.histogram("heliograph_capture_seconds", "From asking for a capture to its file.",
                 render.captures);
  page.counter("heliograph_captures_failed_total",
               "Captures that were answered by an error, at once or after waiting.",
               static_cast<double>(render.failed_captures));
  page.describe("heliograph_pass_seconds", "Each pass of the frames.", "histogram");
  for (const auto& [pass, seconds] : render.by_pass) {
    page.buckets("heliograph_pass_seconds",
                 {{"pass", pass.first}, {"kind", protocol::enum_name(pass.second)}}, seconds);
  }
  page.describe("heliograph_pass_milliseconds", "Each pass of the latest frame.", "gauge");
  for (const protocol::PassTiming& pass : render.passes) {
    page.sample("heliograph_pass_milliseconds",
                {{"pass", pass.name}, {"kind", protocol::enum_name(pass.kind)}}, pass.ms);
  }
  const auto number = [](auto value) { return static_cast<double>(value); };
  page.gauge("heliograph_radiance_cache_cells",
             "Cells of indirect light that the session of the latest frame knows.",
             number(render.radiance_cache.cells));
  page.gauge("heliograph_radiance_cache_cells_limit", "Most of them.",
             number(render.radiance_cache.most_cells));
  page.gauge("heliograph_radiance_cache_bytes", "Memory that its cells take.",
             number(render.radiance_cache.bytes));
}

void add_scenes(Page& page, const session::SessionHost& host) {
  const session::CacheTotals cache = host.scene_cache_totals();
  const auto number = [](std::uint64_t value) { return static_cast<double>(value); };
  page.counter("heliograph_scene_cache_hits_total",
               "Scenes that were asked for and needed no load of their own.", number(cache.hits));
  page.counter("heliograph_scene_cache_misses_total", "Loads of scenes that were begun.",
               number(cache.misses));
  page.counter("heliograph_scene_cache_evictions_total",
               "Scenes dropped to keep within the cache's limit.", number(cache.evictions));
  page.gauge("heliograph_scene_cache_entries", "Scenes in memory.", number(cache.entries));
  page.gauge("heliograph_scene_cache_bytes", "Memory of these scenes.", number(cache.bytes));
}

void add_traffic(Page& page, const Traffic& traffic) {
  const auto number = [](auto value) { return static_cast<double>(value); };
  page.gauge("heliograph_connections", "Open connections.", number(traffic.connections));
  page.counter("heliograph_connections_refused_total", "Connections rejected by a limit.",
               number(traffic.connections_refused));
  page.describe("heliograph_http_responses_total", "HTTP responses by status.", "counter");
  for (const auto& [status, count] : traffic.responses) {
    page.sample("heliograph_http_responses_total", {{"status", std::to_string(status)}},
                number(count));
  }
  page.counter("heliograph_viewer_messages_total", "JSON-RPC messages of viewers.",
               number(traffic.calls));
  page.counter("heliograph_viewer_messages_refused_total",
               "Messages of viewers rejected by the rate limit.", number(traffic.calls_refused));
  page.counter("heliograph_slow_viewers_disconnected_total",
               "Viewers that did not read what they were sent.",
               number(traffic.slow_viewers_disconnected));
}

}  // namespace

std::string metrics_text(const MetricsInput& input) {
  Page page;
  add_process(page, input);
  add_streams(page, input.host);
  add_devices(page, input.host.devices());
  add_rendering(page, input.host);
  add_scenes(page, input.host);
  add_traffic(page, input.traffic);
  return std::move(page).text();
}

}  // namespace heliograph::net
