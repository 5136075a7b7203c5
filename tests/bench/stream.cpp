// Cost of streaming prerendered frames to viewers: encoding, pacing, sockets. Viewers run in a
// separate process and do not decode. Ratios are of one run.
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "net/server.hpp"
#include "tests/bench/frame_playback.hpp"
#include "tests/bench/stream_client.hpp"

namespace heliograph::bench {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr int animation_frames = 12;
constexpr std::size_t crowd = 16;
constexpr std::size_t viewers_beside_a_stalled_one = 4;
constexpr std::size_t idle_sessions = 200;

struct Options {
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

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

double median(const std::vector<double>& values) {
  return percentile(values, 0.5);
}

/// Ratio of two consecutive measurements, so that other load affects both.
double median_ratio(const std::vector<double>& values, const std::vector<double>& others) {
  std::vector<double> ratios(values.size());
  std::transform(values.begin(), values.end(), others.begin(), ratios.begin(), std::divides<>());
  return median(ratios);
}

/// CPU milliseconds of the plain library call per frame at `rate` frames per second; 0: back to
/// back. A core that idles between frames is slower.
double bare_encoding(const std::vector<render::Frame>& frames, double seconds, double rate) {
  const tjhandle handle = tjInitCompress();
  std::vector<unsigned char> buffer(tjBufSize(shown_width, shown_height, TJSAMP_420));
  const Clock::time_point begin = Clock::now();
  const auto end = begin + std::chrono::duration<double>(seconds);
  int count = 0;
  const double before = cpu_seconds();
  while (Clock::now() < end) {
    if (rate > 0) {
      std::this_thread::sleep_until(begin + std::chrono::duration<double>(count / rate));
    }
    const render::Frame& frame = frames[static_cast<std::size_t>(count++) % frames.size()];
    unsigned char* out = buffer.data();
    unsigned long size = buffer.size();
    tjCompress2(handle, frame.rgba.data(), shown_width, 0, shown_height, TJPF_RGBX, &out, &size,
                TJSAMP_420, shown_quality, TJFLAG_NOREALLOC);
  }
  const double spent = cpu_seconds() - before;
  tjDestroy(handle);
  return 1e3 * spent / count;
}

struct Measured {
  double cpu_ms = 0.0;  // per encoded frame
  double cpu_share = 0.0;
  double memory_grown = 0.0;
  double rate = 0.0;  // frames a second, mean of the viewers
  json report;
};

/// The server with an idle renderer.
class Stage {
 public:
  explicit Stage(const Options& options)
      : engine_({}),
        host_({engine_}, hosting()),
        server_(host_, {.port = 0, .access = {}, .router = {}}),
        network_([this] { server_.run(); }),
        frames_(draw_frames(animation_frames)),
        playback_(std::make_unique<FramePlayback>(host_, frames_, options.rate)) {
    const std::string url = server_.url();
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  }
  ~Stage() {
    playback_.reset();
    server_.stop();
    network_.join();
    host_.stop();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  FramePlayback& playback() { return *playback_; }
  session::SessionHost& host() { return host_; }
  const std::vector<render::Frame>& frames() const { return frames_; }

  /// Runs a process of viewers against this server. `idle`: no frames after all viewers are
  /// connected.
  Measured measure(ClientOptions viewers, bool idle = false) {
    viewers.port = port_;
    playback_->set_running(true);
    const std::unique_ptr<FILE, int (*)(FILE*)> process(popen(command(viewers).c_str(), "r"),
                                                        pclose);
    if (!process) throw std::runtime_error("cannot start the viewer process");
    line(*process);
    if (idle) playback_->set_running(false);
    line(*process);
    const Clock::time_point begin = Clock::now();
    const double cpu = cpu_seconds();
    const double memory = resident_megabytes();
    const std::uint64_t encodings = playback_->encodings();
    Measured measured{.report = json::parse(line(*process))};
    playback_->set_running(false);
    const double spent = cpu_seconds() - cpu;
    const std::chrono::duration<double> passed = Clock::now() - begin;
    const auto encoded = static_cast<double>(playback_->encodings() - encodings);
    measured.cpu_ms = 1e3 * spent / std::max(encoded, 1.0);
    measured.cpu_share = spent / passed.count();
    measured.memory_grown = resident_megabytes() - memory;
    const auto frames = measured.report.at("frames").get<std::vector<double>>();
    for (const double count : frames) {
      measured.rate += count / static_cast<double>(frames.size()) / viewers.seconds;
    }
    return measured;
  }

 private:
  static session::HostOptions hosting() {
    session::HostOptions options;
    options.session.width = 64;
    options.session.height = 36;
    options.session.settings.accumulation.max_samples = 1;
    options.limits.sessions = 1 + idle_sessions;
    options.limits.pixels = std::uint64_t{2} * idle_sessions * shown_width * shown_height;
    return options;
  }

  static std::string command(const ClientOptions& viewers) {
    // /proc/self of the shell would be the shell.
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    return "exec '" + program + "' --port " + std::to_string(viewers.port) + " --viewers " +
           std::to_string(viewers.viewers) + " --stalled " + std::to_string(viewers.stalled) +
           " --settle " + std::to_string(viewers.settle) + " --seconds " +
           std::to_string(viewers.seconds);
  }

  static std::string line(FILE& process) {
    char text[4096];
    if (!std::fgets(text, sizeof text, &process))
      throw std::runtime_error("the viewer process failed");
    return text;
  }

  render::Engine engine_;
  session::SessionHost host_;
  net::Server server_;
  std::thread network_;
  std::uint16_t port_ = 0;
  std::vector<render::Frame> frames_;
  std::unique_ptr<FramePlayback> playback_;
};

/// Memory of sessions without viewers, in megabytes.
double sessions_memory(session::SessionHost& host) {
  const double before = resident_megabytes();
  for (std::size_t i = 0; i < idle_sessions; ++i) {
    session::SessionOptions options;
    options.name.clear();
    options.width = shown_width;
    options.height = shown_height;
    const auto made = host.sessions().create(std::move(options));
    if (!made) throw std::runtime_error(made.error().message);
  }
  return resident_megabytes() - before;
}

json run(const Options& options) {
  Stage stage(options);
  ClientOptions one = options.viewers;
  one.viewers = 1;
  ClientOptions many = one;
  many.viewers = crowd;
  ClientOptions beside = one;
  beside.viewers = viewers_beside_a_stalled_one;
  ClientOptions with_stalled = beside;
  with_stalled.stalled = 1;

  std::vector<double> bare, looped, single, crowded, overhead, overhead_crowded, alone, stalled,
      grown;
  std::uint64_t disorder = 0;
  std::uint64_t adapted = 0;
  double rate = 0.0;
  const auto measure = [&](const ClientOptions& viewers) {
    Measured measured = stage.measure(viewers);
    disorder += measured.report.at("disorder").get<std::uint64_t>();
    adapted += measured.report.at("adapted").get<std::uint64_t>();
    return measured;
  };
  for (int round = 0; round < options.rounds; ++round) {
    looped.push_back(bare_encoding(stage.frames(), one.seconds / 2, 0));
    bare.push_back(bare_encoding(stage.frames(), one.seconds, options.rate));
    const Measured with_one = measure(one);
    single.push_back(with_one.cpu_ms);
    overhead.push_back(with_one.report.at("overhead_ms_p95"));
    rate = with_one.rate;
    const Measured with_many = measure(many);
    crowded.push_back(with_many.cpu_ms);
    overhead_crowded.push_back(with_many.report.at("overhead_ms_p95"));
    alone.push_back(measure(beside).rate);
    const Measured with_lazy = measure(with_stalled);
    stalled.push_back(with_lazy.rate);
    grown.push_back(with_lazy.memory_grown);
  }
  ClientOptions idle_options = one;
  idle_options.settle = 1.0;
  const Measured idle = stage.measure(idle_options, true);
  return {{"looped_cpu_ms", median(looped)},
          {"bare_cpu_ms", median(bare)},
          {"one_viewer_cpu_ms", median(single)},
          {"times_bare", median_ratio(single, bare)},
          {"sixteen_viewers_cpu_ms", median(crowded)},
          {"times_one_viewer", median_ratio(crowded, single)},
          {"overhead_ms_p95", median(overhead)},
          {"overhead_of_sixteen_ms_p95", median(overhead_crowded)},
          {"rate", rate},
          {"rate_beside_stalled", median(stalled)},
          {"lost_percent", 100.0 * (1.0 - median_ratio(stalled, alone))},
          {"memory_grown_mb", *std::max_element(grown.begin(), grown.end())},
          {"idle_cpu_percent", 100.0 * idle.cpu_share},
          {"idle_bytes", idle.report.at("bytes")},
          {"idle_sessions_mb", sessions_memory(stage.host())},
          {"disorder", disorder},
          {"adapted", adapted}};
}

struct Row {
  const char* what;
  const char* key;
  const char* unit;
  double bar;  // upper limit; 0: informative
};
constexpr double none = 1e-9;
constexpr Row rows[] = {
    {"libjpeg-turbo alone, back to back", "looped_cpu_ms", "CPU-ms", 0},
    {"  at the frame rate", "bare_cpu_ms", "CPU-ms", 0},
    {"encoded, paced, sent to one viewer", "one_viewer_cpu_ms", "CPU-ms", 3.3},
    {"  relative to the call alone", "times_bare", "", 1.15},
    {"to 16 viewers", "sixteen_viewers_cpu_ms", "CPU-ms", 0},
    {"  relative to one viewer", "times_one_viewer", "", 1.3},
    {"render end to first byte, less encoding, p95", "overhead_ms_p95", "ms", 2},
    {"  with 16 viewers", "overhead_of_sixteen_ms_p95", "ms", 0},
    {"frames per second", "rate", "1/s", 0},
    {"lost beside a stalled viewer", "lost_percent", "%", 5},
    {"memory grown beside a stalled viewer", "memory_grown_mb", "MB", 5},
    {"idle, with a viewer", "idle_cpu_percent", "% CPU", 1},
    {"  bytes sent", "idle_bytes", "", none},
    {"200 idle sessions", "idle_sessions_mb", "MB", 100},
    {"frames out of order", "disorder", "", none},
    {"frames below the requested quality", "adapted", "", 0},
};

bool holds(const Row& row, const json& result) {
  return row.bar == 0 || result.at(row.key).get<double>() < row.bar;
}

void print(const json& result) {
  std::printf("%ux%u, quality %d, prerendered frames\n", shown_width, shown_height, shown_quality);
  for (const Row& row : rows) {
    std::printf("%-46s %9.2f %-8s", row.what, result.at(row.key).get<double>(), row.unit);
    if (row.bar == none) std::printf(" none");
    if (row.bar > none) std::printf(" < %g", row.bar);
    std::printf("%s\n", holds(row, result) ? "" : "  MISSED");
  }
}

void watch_and_tell(const ClientOptions& options) {
  const auto say = [](const char* what) {
    std::printf("%s\n", what);
    std::fflush(stdout);
  };
  const ClientReport report = watch(options, [=](bool settled) { say(settled ? "go" : "there"); });
  const json line{{"frames", report.frames},
                  {"overhead_ms_p50", percentile(report.overhead_ms, 0.5)},
                  {"overhead_ms_p95", percentile(report.overhead_ms, 0.95)},
                  {"bytes", report.bytes},
                  {"adapted", report.adapted},
                  {"disorder", report.disorder}};
  say(line.dump().c_str());
}

}  // namespace
}  // namespace heliograph::bench

int main(int argc, char** argv) {
  using namespace heliograph::bench;
  Options options;
  CLI::App app{"Measures the cost of streaming frames to viewers."};
  bool as_json = false;
  bool check = false;
  app.add_option("--seconds", options.viewers.seconds, "Length of each measurement.");
  app.add_option("--settle", options.viewers.settle, "Time before it.");
  app.add_option("--rate", options.rate, "Frames per second.");
  app.add_option("--rounds", options.rounds, "Number of measurements; the median is reported.");
  app.add_flag("--json", as_json, "Print one line of JSON instead of a table.");
  app.add_flag("--check", check, "Fail if a limit is exceeded.");
  app.add_option("--port", options.viewers.port,
                 "Run as the viewer process of the server at this port.");
  app.add_option("--viewers", options.viewers.viewers, "Number of viewers.");
  app.add_option("--stalled", options.viewers.stalled,
                 "Number of additional viewers that read nothing.");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::warn);
  try {
    if (options.viewers.port != 0) {
      watch_and_tell(options.viewers);
      return 0;
    }
    const nlohmann::json result = run(options);
    as_json ? static_cast<void>(std::printf("%s\n", result.dump().c_str())) : print(result);
    const bool passed = std::all_of(std::begin(rows), std::end(rows),
                                    [&](const Row& row) { return holds(row, result); });
    return check && !passed ? 1 : 0;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph-bench-stream: %s\n", failure.what());
    return 1;
  }
}
