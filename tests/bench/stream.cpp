// What it costs to get pictures that are there already to viewers: encoding, pacing, sockets.
// Viewers run in a process of their own and do not decode. Ratios are of one run.
#include <sys/resource.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>

#include "net/server.hpp"
#include "session/broadcast.hpp"
#include "tests/bench/stream_client.hpp"

namespace heliograph::bench {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr std::uint32_t width = 1280;
constexpr std::uint32_t height = 720;
constexpr int quality = 80;
constexpr int pictures_in_a_circle = 12;

struct Options {
  double seconds = 5.0;
  double rate = 60.0;
  int rounds = 3;
  ClientOptions viewers;
};

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Shaded waves with fine grain and hard edges: about as many bytes as a rendered interior.
render::Frame draw(int number) {
  render::Frame frame{.width = width, .height = height};
  frame.rgba.resize(std::size_t{4} * width * height);
  std::uint32_t random = 12345u + static_cast<std::uint32_t>(number);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const float u = static_cast<float>(x) + 8.0f * static_cast<float>(number);
      const float v = static_cast<float>(y);
      const bool tile = (static_cast<int>(u) / 64 + static_cast<int>(v) / 48) % 2 != 0;
      random = random * 1664525u + 1013904223u;
      const float grain = static_cast<float>(random >> 24) / 255.0f * 8.0f;
      const float light = 110.0f + 60.0f * std::sin(u * 0.011f) * std::cos(v * 0.017f) + grain;
      std::uint8_t* const pixel = &frame.rgba[std::size_t{4} * (y * width + x)];
      pixel[0] = static_cast<std::uint8_t>(light * (tile ? 1.0f : 0.6f));
      pixel[1] = static_cast<std::uint8_t>(light * (tile ? 0.9f : 0.7f));
      pixel[2] = static_cast<std::uint8_t>(light * (tile ? 0.7f : 0.8f));
      pixel[3] = 255;
    }
  }
  return frame;
}

/// CPU milliseconds of the bare library call for one picture.
double bare_encoding(const std::vector<render::Frame>& pictures, double seconds) {
  const tjhandle handle = tjInitCompress();
  std::vector<unsigned char> buffer(tjBufSize(width, height, TJSAMP_420));
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(seconds));
  int count = 0;
  const double before = cpu_seconds();
  while (Clock::now() < end) {
    const render::Frame& picture = pictures[static_cast<std::size_t>(count++) % pictures.size()];
    unsigned char* out = buffer.data();
    unsigned long size = buffer.size();
    tjCompress2(handle, picture.rgba.data(), width, 0, height, TJPF_RGBX, &out, &size, TJSAMP_420,
                quality, TJFLAG_NOREALLOC);
  }
  const double spent = cpu_seconds() - before;
  tjDestroy(handle);
  return 1e3 * spent / count;
}

/// A renderer that has drawn everything before: a thread that shows pictures at a steady rate.
class Show {
 public:
  Show(session::SessionHost& host, std::vector<render::Frame> frames, double rate)
      : session_(host.sessions().main()),
        worker_("encoder", 1),
        broadcast_(session_, {.encoder = worker_,
                              .jpeg = jpeg_,
                              .measurements = measurements_,
                              .wakeup = wakeup_,
                              .tracer = host.engine().tracer()}),
        interval_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1.0 / rate))) {
    for (render::Frame& frame : frames) {
      auto picture = std::make_shared<session::Picture>();
      picture->frame = std::move(frame);
      pictures_.push_back(std::move(picture));
    }
    // The session's own renderer has numbered the few pictures that it drew.
    for (int i = 0; i < 1000; ++i) broadcast_.rendered(next_picture(), false);
    thread_ = std::thread([this] { run(); });
  }
  ~Show() {
    stopping_ = true;
    thread_.join();
    worker_.stop();
  }
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;

  void set_running(bool running) { running_ = running; }
  std::uint64_t encodings() const { return measurements_.totals().encodings.count(); }

 private:
  /// Pictures come round again long after they were encoded.
  std::shared_ptr<session::Picture> next_picture() {
    const std::shared_ptr<session::Picture>& picture = pictures_[shown_ % pictures_.size()];
    protocol::FrameHeader& header = picture->header;
    header.render_id = ++shown_;
    header.full_width = width;
    header.full_height = height;
    header.render_start_us = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
            .count());
    return picture;
  }

  void run() {
    Clock::time_point next = Clock::now();
    while (!stopping_) {
      next = std::max(next + interval_, Clock::now() - interval_);
      std::this_thread::sleep_until(next);
      if (!running_ || broadcast_.behind()) continue;
      broadcast_.rendered(next_picture(), false);
      broadcast_.pump();
    }
  }

  std::shared_ptr<session::Session> session_;
  stream::JpegEncoder jpeg_;
  session::Measurements measurements_;
  session::Worker worker_;
  std::shared_ptr<session::Wakeup> wakeup_ = std::make_shared<session::Wakeup>();
  session::Broadcast broadcast_;
  std::vector<std::shared_ptr<session::Picture>> pictures_;
  std::uint32_t shown_ = 0;
  Clock::duration interval_;
  std::atomic<bool> running_ = true;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

struct Measured {
  double cpu_ms = 0.0;  // for each picture that was encoded
  double memory_grown = 0.0;
  json report;
};

/// Runs a process of viewers against this one.
Measured measure(const Show& show, const ClientOptions& viewers) {
  const std::string command = "exec /proc/self/exe --port " + std::to_string(viewers.port) +
                              " --viewers " + std::to_string(viewers.viewers) + " --stalled " +
                              std::to_string(viewers.stalled) + " --seconds " +
                              std::to_string(viewers.seconds);
  const std::unique_ptr<FILE, int (*)(FILE*)> process(popen(command.c_str(), "r"), pclose);
  if (!process) throw std::runtime_error("the viewers cannot be started");
  char line[4096];
  if (!std::fgets(line, sizeof line, process.get())) throw std::runtime_error("no viewer came");
  const double cpu = cpu_seconds();
  const double memory = resident_megabytes();
  const std::uint64_t encodings = show.encodings();
  if (!std::fgets(line, sizeof line, process.get())) throw std::runtime_error("viewers failed");
  const auto pictures = static_cast<double>(show.encodings() - encodings);
  return {.cpu_ms = 1e3 * (cpu_seconds() - cpu) / std::max(pictures, 1.0),
          .memory_grown = resident_megabytes() - memory,
          .report = json::parse(line)};
}

double mean_rate(const json& frames, double seconds) {
  double sum = 0.0;
  for (const auto& count : frames) sum += count.get<double>();
  return frames.empty() ? 0.0 : sum / static_cast<double>(frames.size()) / seconds;
}

void print_client_report(const ClientOptions& options) {
  const ClientReport report = watch(options);
  const json line{{"frames", report.frames},
                  {"frames_before_stall", report.frames_before_stall},
                  {"overhead_ms_p50", percentile(report.overhead_ms, 0.5)},
                  {"overhead_ms_p95", percentile(report.overhead_ms, 0.95)},
                  {"bytes", report.bytes},
                  {"disorder", report.disorder}};
  std::printf("%s\n", line.dump().c_str());
}

json idle(Show& show, double seconds) {
  show.set_running(false);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const double cpu = cpu_seconds();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const double share = (cpu_seconds() - cpu) / seconds;
  show.set_running(true);
  return {{"cpu_percent", 100.0 * share}};
}

json run(const Options& options) {
  render::Engine engine({});
  session::HostOptions hosting;
  hosting.session.width = 64;
  hosting.session.height = 36;
  hosting.session.settings.accumulation.max_samples = 1;
  session::SessionHost host(engine, hosting);
  net::Server server(host, {.port = 0});
  std::thread network([&] { server.run(); });
  const std::string url = server.url();
  const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));

  std::vector<render::Frame> pictures;
  for (int i = 0; i < pictures_in_a_circle; ++i) pictures.push_back(draw(i));
  std::vector<double> bare;
  std::vector<double> one;
  std::vector<double> many;
  std::vector<double> overhead;
  json last_one;
  json stalled;
  json idling;
  std::uint64_t disorder = 0;
  {
    const std::vector<render::Frame> originals = pictures;
    Show show(host, std::move(pictures), options.rate);
    const auto with = [&](std::size_t viewers, std::size_t lazy) {
      Measured measured = measure(show, {.port = port,
                                         .viewers = viewers,
                                         .stalled = lazy,
                                         .seconds = options.seconds});
      disorder += measured.report.at("disorder").get<std::uint64_t>();
      return measured;
    };
    for (int round = 0; round < options.rounds; ++round) {
      show.set_running(false);
      bare.push_back(bare_encoding(originals, options.seconds / 2));
      show.set_running(true);
      const Measured single = with(1, 0);
      one.push_back(single.cpu_ms);
      overhead.push_back(single.report.at("overhead_ms_p95").get<double>());
      last_one = single.report;
      many.push_back(with(16, 0).cpu_ms);
    }
    const Measured beside = with(4, 1);
    const double before = mean_rate(beside.report.at("frames_before_stall"), options.seconds);
    const double after = mean_rate(beside.report.at("frames"), options.seconds);
    stalled = {{"rate_before", before},
               {"rate_beside", after},
               {"lost_percent", 100.0 * (1.0 - after / before)},
               {"memory_grown_mb", beside.memory_grown}};
    idling = idle(show, options.seconds);
  }
  server.stop();
  network.join();
  host.stop();
  return {{"bare_cpu_ms", median(bare)},
          {"one_viewer_cpu_ms", median(one)},
          {"times_bare", median(one) / median(bare)},
          {"sixteen_viewers_cpu_ms", median(many)},
          {"times_one_viewer", median(many) / median(one)},
          {"overhead_ms_p95", median(overhead)},
          {"rate", mean_rate(last_one.at("frames"), options.seconds)},
          {"disorder", disorder},
          {"stalled", stalled},
          {"idle", idling}};
}

void print(const json& result) {
  const auto row = [](const char* what, double value, const char* unit, const char* bar) {
    std::printf("%-44s %9.2f %-8s %s\n", what, value, unit, bar);
  };
  std::printf("1280x720, quality 80, pictures drawn before\n");
  row("libjpeg-turbo alone", result.at("bare_cpu_ms"), "CPU-ms", "");
  row("encoded, paced, sent to one viewer", result.at("one_viewer_cpu_ms"), "CPU-ms", "< 3.3");
  row("  times the bare call", result.at("times_bare"), "", "< 1.15");
  row("to 16 viewers", result.at("sixteen_viewers_cpu_ms"), "CPU-ms", "");
  row("  times one viewer", result.at("times_one_viewer"), "", "< 1.3");
  row("render end to first byte, less encoding, p95", result.at("overhead_ms_p95"), "ms", "< 2");
  row("pictures a second", result.at("rate"), "1/s", "");
  row("lost beside a stalled viewer", result.at("stalled").at("lost_percent"), "%", "< 5");
  row("memory grown beside a stalled viewer", result.at("stalled").at("memory_grown_mb"), "MB",
      "flat");
  row("idle with nobody moving", result.at("idle").at("cpu_percent"), "% CPU", "< 1");
  row("frames out of order", result.at("disorder"), "", "0");
}

}  // namespace
}  // namespace heliograph::bench

int main(int argc, char** argv) {
  using namespace heliograph::bench;
  Options options;
  CLI::App app{"Measures what it costs to get pictures to viewers."};
  bool as_json = false;
  app.add_option("--seconds", options.viewers.seconds, "Length of each measurement.");
  app.add_option("--rate", options.rate, "Pictures a second.");
  app.add_option("--rounds", options.rounds, "Measurements, of which the median counts.");
  app.add_flag("--json", as_json, "Print one line of JSON instead of a table.");
  app.add_option("--port", options.viewers.port, "Be the viewers of the server at this port.");
  app.add_option("--viewers", options.viewers.viewers, "How many.");
  app.add_option("--stalled", options.viewers.stalled, "How many more that read nothing.");
  CLI11_PARSE(app, argc, argv);
  options.seconds = options.viewers.seconds;
  try {
    if (options.viewers.port != 0) {
      print_client_report(options.viewers);
      return 0;
    }
    const nlohmann::json result = run(options);
    if (as_json) {
      std::printf("%s\n", result.dump().c_str());
    } else {
      print(result);
    }
    return 0;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
}
