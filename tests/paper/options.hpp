#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/paper/stage.hpp"

namespace heliograph::paper {

/// A row of the tables: its name and its settings.
using Row = std::pair<std::string, protocol::Settings>;

/// What the command line of heliograph-experiments asks for.
struct Options {
  std::vector<std::string> scenes;
  std::vector<std::string> presets;
  std::string preset_file;  // measured beside `against`, in place of `presets`
  std::string against = "best";
  std::vector<std::string> movements{"static", "moving_camera", "moving_objects_light"};
  std::vector<float> values;
  std::vector<std::string> settings;  // path=value, on top of every preset
  std::vector<std::string> variants;  // name:path=value,path=value, on top of those of `best`
  std::vector<int> seeds{0};          // of random sequences: a measurement of each
  std::string size = "320x180";
  int frames = 60;
  int samples = 512;
  int texture_size = 256;
  float draw_scale = 1.0f;
  float frame_rate = 60.0f;
  std::string ground_truth = "reference";
  std::string ground_truth_folder;
  std::string output;
  std::string device;
  std::string tracer = "auto";
  bool without_quality = false;
  bool without_timings = false;
  bool over_time = false;

  /// @throws std::invalid_argument
  StageOptions stage() const;
  /// The presets or the file and what it is compared with, then the variants.
  /// @throws std::invalid_argument where a name or a setting is unknown
  std::vector<Row> rows() const;
  /// Ground truth of a shot, from the folder of those that earlier runs have left.
  std::vector<render::Frame> truth(const Stage& stage, const std::string& name,
                                   const Shot& shot) const;
  Shot shot(const std::string& movement) const;
  /// The swept values of a scene: those of the command line, or the paper's.
  std::vector<float> values_for(Swept swept) const;
};

void add_options(CLI::App& app, Options& options);

}  // namespace heliograph::paper
