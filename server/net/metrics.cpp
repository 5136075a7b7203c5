#include "net/metrics.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string_view>

namespace heliograph::net {
namespace {

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
  /// A summary without quantiles: how often and how long in all.
  void summary(std::string_view name, std::string_view help, double sum, std::uint64_t count) {
    describe(name, help, "summary");
    sample(fmt::format("{}_sum", name), {}, sum);
    sample(fmt::format("{}_count", name), {}, static_cast<double>(count));
  }
  void describe(std::string_view name, std::string_view help, std::string_view type) {
    text_ +=
        fmt::format("# HELP heliograph_{0} {1}\n# TYPE heliograph_{0} {2}\n", name, help, type);
  }
  void sample(std::string_view name, std::string_view labels, double value) {
    text_ += fmt::format("heliograph_{}{} {}\n", name, labels, value);
  }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

double resident_bytes() {
  std::ifstream statistics("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  statistics >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

std::string metrics_text(const session::SessionHost& host,
                         std::chrono::steady_clock::time_point started) {
  const session::RenderTotals render = host.render_totals();
  const session::AudienceTotals audience = host.sessions().totals();
  const std::chrono::duration<double> uptime = std::chrono::steady_clock::now() - started;
  const std::chrono::duration<double> round_trip = audience.mean_round_trip;

  Page page;
  page.gauge("uptime_seconds", "Time since the server started.", uptime.count());
  page.gauge("resident_memory_bytes", "Memory in use.", resident_bytes());
  page.gauge("ready", "1 once a picture has been rendered.", host.ready() ? 1 : 0);
  page.gauge("viewers", "Connected viewers.", static_cast<double>(audience.viewers));
  page.counter("frames_sent_total", "Frames sent to viewers.",
               static_cast<double>(audience.sent.frames));
  page.counter("sent_bytes_total", "Bytes of the frames sent to viewers.",
               static_cast<double>(audience.sent.bytes));
  page.counter("frames_dropped_total", "Frames that a newer one replaced before they were sent.",
               static_cast<double>(audience.sent.dropped));
  page.gauge("round_trip_seconds", "Mean time from sending a frame to its acknowledgement.",
             round_trip.count());
  page.gauge("goodput_bytes_per_second", "Acknowledged bytes of all viewers.", audience.goodput);
  page.summary("render_seconds", "Rendering, per frame.", render.render_seconds, render.frames);
  page.summary("encode_seconds", "Encoding, per picture.", render.encode_seconds, render.encodings);
  page.describe("pass_milliseconds", "Each pass of the latest frame.", "gauge");
  for (const protocol::PassTiming& pass : render.passes) {
    page.sample(
        "pass_milliseconds",
        fmt::format("{{pass=\"{}\",kind=\"{}\"}}", pass.name, protocol::enum_name(pass.kind)),
        pass.ms);
  }
  return std::move(page).text();
}

}  // namespace heliograph::net
