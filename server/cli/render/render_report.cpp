#include "cli/render/render_report.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "protocol/json/raw_json.hpp"

namespace heliograph::cli {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  const double exact =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::round(1000.0 * exact) / 1000.0;
}

/// "1 h 05 min", "3 min 20 s" or "12 s"
std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  const auto two_digits = [](long long value) {
    return (value < 10 ? "0" : "") + std::to_string(value);
  };
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + two_digits(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + two_digits(whole / 60 % 60) + " min";
}

}  // namespace

RenderReport::RenderReport(ProgressKind kind, std::size_t entries, std::size_t images)
    : kind_(kind), entries_(entries), images_(images) {
  show_line();
}

void RenderReport::begin(std::size_t number, const std::string& scene, std::size_t images,
                         std::size_t expected) {
  images_ += images - expected;
  entry_started_ = Clock::now();
  current_ = {{"entry", number}, {"scene", scene}, {"files", nlohmann::json::array()}};
  print({{"event", "started"}, {"entry", number}, {"scene", scene}, {"images", images}});
  show_line();
}

void RenderReport::keep(const std::filesystem::path& file, std::size_t images) {
  kept_ += images;
  current_["files"].push_back(file.string());
  print({{"event", "kept"}, {"entry", current_["entry"]}, {"file", file.string()}});
  show_line();
}

void RenderReport::image(std::uint32_t samples) {
  ++rendered_;
  current_["samples"] = samples;
  print({{"event", "image"},
         {"entry", current_["entry"]},
         {"samples", samples},
         {"done", rendered_ + kept_},
         {"total", images_},
         {"seconds_left", seconds_left()}});
  show_line();
}

void RenderReport::file(const std::filesystem::path& file) {
  if (file.empty()) return;
  current_["files"].push_back(file.string());
  print({{"event", "written"}, {"entry", current_["entry"]}, {"file", file.string()}});
}

void RenderReport::done() {
  ++done_;
  finish(current_["entry"], current_["scene"], "done", {});
}

void RenderReport::fail(std::size_t number, const std::string& scene, const std::string& reason) {
  ++failed_;
  if (kind_ == ProgressKind::terminal) std::fputs("\r\033[K", stderr);
  std::fprintf(stderr, "heliograph: %s: %s\n", scene.c_str(), reason.c_str());
  finish(number, scene, "failed", reason);
}

void RenderReport::cancel(std::size_t number, const std::string& scene) {
  finish(number, scene, "canceled", {});
}

void RenderReport::finish(std::size_t number, const std::string& scene, const char* state,
                          const std::string& reason) {
  const bool began = current_.is_object() && current_["entry"] == number;
  nlohmann::json entry =
      began
          ? std::move(current_)
          : nlohmann::json{{"entry", number}, {"scene", scene}, {"files", nlohmann::json::array()}};
  entry["state"] = state;
  entry["seconds"] = began ? seconds_since(entry_started_) : 0.0;
  if (!reason.empty()) entry["reason"] = reason;
  current_ = nullptr;
  nlohmann::json event = entry;
  event.erase("files");
  event["event"] = state;
  print(event);
  list_.push_back(std::move(entry));
  show_line();
}

double RenderReport::seconds_left() const {
  if (rendered_ == 0) return 0.0;
  const std::size_t complete = rendered_ + kept_;
  const std::size_t left = images_ > complete ? images_ - complete : 0;
  return std::round(10.0 * seconds_since(started_) * static_cast<double>(left) /
                    static_cast<double>(rendered_)) /
         10.0;
}

void RenderReport::print(const nlohmann::json& event) const {
  if (kind_ != ProgressKind::json) return;
  std::printf("%s\n", protocol::RawJson(event).text().c_str());
  std::fflush(stdout);
}

void RenderReport::show_line() const {
  if (kind_ != ProgressKind::terminal) return;
  std::string line = std::to_string(rendered_ + kept_) + " of " + std::to_string(images_) +
                     (images_ == 1 ? " image" : " images");
  if (failed_ > 0) line += ", " + std::to_string(failed_) + " failed";
  if (rendered_ > 0 && seconds_left() > 0) line += ", " + duration_text(seconds_left()) + " left";
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  std::fflush(stderr);
}

void RenderReport::end() {
  print({{"event", "finished"},
         {"done", done_},
         {"failed", failed_},
         {"entries", entries_},
         {"images", rendered_},
         {"kept", kept_},
         {"seconds", seconds_since(started_)}});
  if (kind_ == ProgressKind::terminal) std::fputc('\n', stderr);
}

nlohmann::json RenderReport::json() const {
  return {{"entries", list_},    {"done", done_}, {"failed", failed_},
          {"images", rendered_}, {"kept", kept_}, {"seconds", seconds_since(started_)}};
}

}  // namespace heliograph::cli
