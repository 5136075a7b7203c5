#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "render/api/renderer.hpp"
#include "tests/paper/cases.hpp"
#include "tests/paper/quality.hpp"

namespace heliograph::paper {

/// One point of a figure.
struct Measurement {
  std::string scene;
  Swept swept = Swept::roughness;
  float value = 0.0f;
  Movement movement = Movement::still;
  std::string technique;
  Quality quality;
  int seed = 0;
};

/// The beginning of the names of a measurement's images.
std::string image_name(const Measurement& measurement);

/// Frame rates of one scene and one technique, with the mean time of each pass.
struct Timing {
  std::string scene;
  std::string technique;
  Movement movement = Movement::still;
  std::optional<float> value;  // without, the scene has its own materials and sun
  double slowest_fps = 0.0;
  double mean_fps = 0.0;
  double fastest_fps = 0.0;
  std::vector<render::PassTime> passes;
};

/// One frame of a static view.
struct Moment {
  std::string scene;
  std::string technique;
  std::optional<float> value;
  int frame = 0;
  double ssim = 0.0;
};

struct Results {
  std::vector<Measurement> measurements;
  std::vector<Timing> timings;
  std::vector<Moment> moments;
};

/// Summary of the frames after the first `warm_up`. @throws std::invalid_argument where none remain
Timing summarise(const std::vector<render::Frame>& frames, int warm_up);

/// Tables of SSIM, flicker and luminance per scene and movement: a row per technique, a column per
/// swept value, the mean of all seeds.
std::string quality_tables(const std::vector<Measurement>& measurements);
/// The paper's tables 1 and 2, then milliseconds of each pass.
std::string timing_tables(const std::vector<Timing>& timings);

/// quality.csv, timings.csv, passes.csv, over_time.csv, and experiments.json, which has what the
/// run was, too. @throws std::runtime_error
void write_files(const std::filesystem::path& folder, const Results& results,
                 const nlohmann::json& run);

}  // namespace heliograph::paper
