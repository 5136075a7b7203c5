// A viewer that moves the camera of a server on the same machine: frames a second, from input to
// frame, and who has encoded the frames. Of the server everything is real.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/viewers/moving_viewer.hpp"
#include "tests/bench/viewers/server_process.hpp"

namespace heliograph::bench {
namespace {

using nlohmann::json;

struct Options {
  std::string server;
  std::vector<std::string> arguments;
  std::string size = "1920x1080";
  MovingOptions viewer;
  double most_ms = 0.0;  // input to frame, median; 0: any
};

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

template <class Value>
double median_of(const std::vector<ShownFrame>& frames, Value value) {
  std::vector<double> values;
  for (const ShownFrame& frame : frames) values.push_back(static_cast<double>(value(frame)));
  return quantile(values, 0.5);
}

/// What is left of the way of a frame: waiting for the encoder, the socket, and this program.
double rest_us(const ShownFrame& frame) {
  const protocol::FrameHeader& header = frame.header;
  return frame.received_us - static_cast<double>(header.render_start_us) - header.render_us -
         header.encode_us - header.queue_us;
}

/// Milliseconds but for sizes. Frames without a new input tell nothing about waiting.
json summary_of(const std::vector<ShownFrame>& frames, double seconds) {
  std::vector<double> latencies;
  std::vector<ShownFrame> answers;
  for (const ShownFrame& frame : frames) {
    latencies.insert(latencies.end(), frame.input_ms.begin(), frame.input_ms.end());
    if (!frame.input_ms.empty()) answers.push_back(frame);
  }
  return {
      {"frames", frames.size()},
      {"rate", static_cast<double>(frames.size()) / seconds},
      {"width", median_of(frames, [](const auto& frame) { return frame.header.width; })},
      {"quality", median_of(frames, [](const auto& frame) { return frame.header.quality; })},
      {"kilobytes", median_of(frames, [](const auto& frame) { return frame.bytes; }) / 1e3},
      {"inputs", latencies.size()},
      {"input_p50", quantile(latencies, 0.5)},
      {"input_p95", quantile(latencies, 0.95)},
      {"wait", median_of(answers, [](const auto& frame) { return frame.wait_ms; })},
      {"render", median_of(frames, [](const auto& frame) { return frame.header.render_us; }) / 1e3},
      {"encode", median_of(frames, [](const auto& frame) { return frame.header.encode_us; }) / 1e3},
      {"queue", median_of(frames, [](const auto& frame) { return frame.header.queue_us; }) / 1e3},
      {"rest", median_of(frames, rest_us) / 1e3}};
}

/// Of all frames, and of those that the device and the processors have encoded.
json measure(const ServerProcess& server, const MovingOptions& options) {
  double cpu = 0.0;
  const std::vector<ShownFrame> frames =
      move_and_watch(options, [&] { cpu = server.cpu_seconds(); });
  cpu = server.cpu_seconds() - cpu;
  if (frames.empty()) throw std::runtime_error("no frame was received");
  std::vector<ShownFrame> device;
  std::vector<ShownFrame> processor;
  std::partition_copy(frames.begin(), frames.end(), std::back_inserter(device),
                      std::back_inserter(processor),
                      [](const ShownFrame& frame) { return frame.by_device; });
  return {{"all", summary_of(frames, options.seconds)},
          {"device", summary_of(device, options.seconds)},
          {"processor", summary_of(processor, options.seconds)},
          {"cpu_ms_of_a_frame", 1e3 * cpu / static_cast<double>(frames.size())}};
}

void print(const char* title, const json& result) {
  std::printf("%s; %.2f CPU-ms of the server for a frame\n", title,
              result.at("cpu_ms_of_a_frame").get<double>());
  std::printf("%-10s %8s %6s %8s %7s | %9s %9s | %7s %7s %7s %7s %7s\n", "encoded by", "frames/s",
              "width", "quality", "KB", "input p50", "p95 ms", "wait", "render", "encode", "queue",
              "rest");
  for (const char* const kind : {"all", "device", "processor"}) {
    const json& row = result.at(kind);
    if (row.at("frames") == 0) {
      std::printf("%-10s %8s\n", kind, "none");
      continue;
    }
    const auto at = [&](const char* key) { return row.at(key).get<double>(); };
    std::printf("%-10s %8.1f %6.0f %8.0f %7.0f | %9.2f %9.2f | %7.2f %7.2f %7.2f %7.2f %7.2f\n",
                kind, at("rate"), at("width"), at("quality"), at("kilobytes"), at("input_p50"),
                at("input_p95"), at("wait"), at("render"), at("encode"), at("queue"), at("rest"));
  }
}

json run(Options options) {
  char end = 0;
  if (std::sscanf(options.size.c_str(), "%ux%u%c", &options.viewer.width, &options.viewer.height,
                  &end) != 2) {
    throw std::runtime_error("--size " + options.size + " must look like 1920x1080");
  }
  const ServerProcess server(options.server, options.arguments);
  options.viewer.port = server.port();
  const json scheduled = measure(server, options.viewer);
  options.viewer.inputs = 0.0;
  return {{"scheduled", scheduled}, {"in_turn", measure(server, options.viewer)}};
}

std::string program_beside_this(const char* name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

}  // namespace
}  // namespace heliograph::bench

int main(int argc, char** argv) {
  using namespace heliograph::bench;
  Options options;
  options.server = program_beside_this("heliograph");
  CLI::App app{"Measures a moving session of a server from outside, by who encodes its frames."};
  bool as_json = false;
  app.add_option("--server", options.server, "The program heliograph; that beside this one.");
  app.add_option("--size", options.size, "Of the frames.")->capture_default_str();
  app.add_option("--quality", options.viewer.quality, "Of their JPEGs.")->capture_default_str();
  app.add_option("--max-fps", options.viewer.max_fps, "What the viewer asks for.")
      ->capture_default_str();
  app.add_option("--inputs", options.viewer.inputs, "A second, in the first measurement.")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--settle", options.viewer.settle, "Seconds before each measurement.")
      ->capture_default_str();
  app.add_option("--seconds", options.viewer.seconds, "Of each measurement.")
      ->capture_default_str();
  app.add_option("--most-ms", options.most_ms,
                 "Fail if the median from input to frame is longer, or the processors encode.");
  app.add_flag("--json", as_json, "Print one line of JSON instead of tables.");
  app.add_option("arguments", options.arguments, "Behind --: those of heliograph serve.");
  CLI11_PARSE(app, argc, argv);
  try {
    const nlohmann::json result = run(options);
    if (as_json) {
      std::printf("%s\n", result.dump().c_str());
    } else {
      print("inputs at a rate", result.at("scheduled"));
      print("each input when the last was shown", result.at("in_turn"));
    }
    const bool missed = options.most_ms > 0.0 && std::ranges::any_of(result, [&](const auto& one) {
                          return one.at("all").at("input_p50") > options.most_ms ||
                                 one.at("processor").at("frames") > 0;
                        });
    return missed ? 1 : 0;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph-bench-latency: %s\n", failure.what());
    return 1;
  }
}
