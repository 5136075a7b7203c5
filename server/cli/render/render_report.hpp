#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace heliograph::cli {

enum class ProgressKind { none, terminal, json };

/// What becomes of the entries of a command: told while they are rendered, on a terminal or as a
/// line of JSON for each event, and as a report at the end.
class RenderReport {
 public:
  /// `images`: how many there will be, as far as that is known.
  RenderReport(ProgressKind kind, std::size_t entries, std::size_t images);

  /// An entry begins. `number`: of the manifest's; `images`: how many it has, of which `expected`
  /// were counted before.
  void begin(std::size_t number, const std::string& scene, std::size_t images,
             std::size_t expected);
  /// A file of so many images was there already.
  void keep(const std::filesystem::path& file, std::size_t images);
  /// An image was rendered.
  void image(std::uint32_t samples);
  /// A file of one or several images was written.
  void file(const std::filesystem::path& file);
  void done();
  void fail(std::size_t number, const std::string& scene, const std::string& reason);
  /// The command ends before this entry is complete.
  void cancel(std::size_t number, const std::string& scene);

  std::size_t failed() const { return failed_; }
  /// Ends the progress on a terminal.
  void end();
  /// {"entries": [{"entry": 1, "scene": "a.glb", "state": "done", "files": [...], ...}], ...}
  nlohmann::json json() const;

 private:
  void print(const nlohmann::json& event) const;
  void show_line() const;
  void finish(std::size_t number, const std::string& scene, const char* state,
              const std::string& reason);
  double seconds_left() const;

  using Clock = std::chrono::steady_clock;
  const ProgressKind kind_;
  const Clock::time_point started_ = Clock::now();
  const std::size_t entries_;
  std::size_t images_;
  std::size_t rendered_ = 0;  // images
  std::size_t kept_ = 0;
  std::size_t done_ = 0;  // entries
  std::size_t failed_ = 0;
  Clock::time_point entry_started_ = started_;
  nlohmann::json current_;
  nlohmann::json list_ = nlohmann::json::array();
};

}  // namespace heliograph::cli
