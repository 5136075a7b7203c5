// Regenerates the figures and tables of section 4 of Granja and Pereira, "Hybrid-Rendering
// Techniques in GPU" (2021): SSIM over roughness and shadow angle, and frame rates.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "protocol/settings/settings_json.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "tests/paper/options.hpp"
#include "tests/paper/report.hpp"
#include "tests/paper/stage.hpp"
#include "tests/support/image_comparison.hpp"
#include "tests/support/similarity.hpp"

namespace heliograph::paper {
namespace {

/// One row with each seed; the last frame of the first is saved.
void measure_row(const Stage& stage, const Options& options, const Row& row, const Shot& shot,
                 const std::vector<render::Frame>& ground_truth, Measurement measurement,
                 std::vector<Measurement>& measurements) {
  auto [name, settings] = row;
  for (const int seed : options.seeds) {
    settings.sampling.seed = seed;
    const Played played = stage.play(settings, shot);
    if (seed == options.seeds.front()) {
      test::save_image(image_name(measurement) + name, played.frames.back());
    }
    measurement.technique = name;
    measurement.seed = seed;
    measurement.quality = compare(played.frames, ground_truth);
    std::fprintf(stderr, "%s%s: ssim %.4f flicker %.2f luminance %.3f rays %.3f\n",
                 image_name(measurement).c_str(), name.c_str(), measurement.quality.ssim,
                 measurement.quality.flicker, measurement.quality.luminance_ratio,
                 played.rays_per_pixel);
    measurements.push_back(measurement);
  }
}

std::vector<Measurement> measure_quality(render::Engine& engine, const Options& options) {
  std::vector<Measurement> measurements;
  for (const std::string& scene : options.scenes) {
    const Swept swept = swept_in(scene);
    const std::size_t first = measurements.size();
    for (const float value : options.values_for(swept)) {
      const Stage stage(engine, scene, sweep_to(swept, value), options.stage());
      for (const std::string& movement : options.movements) {
        const Shot shot = options.shot(movement);
        const Measurement measured{scene, swept, value, shot.movement, {}, {}};
        const auto ground_truth = options.truth(stage, image_name(measured), shot);
        test::save_image(image_name(measured) + "ground_truth", ground_truth.back());
        for (const Row& row : options.rows()) {
          measure_row(stage, options, row, shot, ground_truth, measured, measurements);
        }
      }
    }
    const std::vector<Measurement> of_scene(measurements.begin() + std::ptrdiff_t(first),
                                            measurements.end());
    std::fputs(quality_tables(of_scene).c_str(), stdout);
    std::fflush(stdout);
  }
  return measurements;
}

/// The scene as it is, or with each swept value that the command line names.
std::vector<std::optional<float>> values_to_time(const Options& options) {
  if (options.values.empty()) return {std::nullopt};
  return {options.values.begin(), options.values.end()};
}

scenes::Sweep sweep_of(const std::string& scene, std::optional<float> value) {
  return value ? sweep_to(swept_in(scene), *value) : scenes::Sweep{};
}

std::vector<Timing> measure_times(render::Engine& engine, const Options& options) {
  constexpr int warm_up = 5;
  std::vector<Timing> timings;
  for (const std::string& scene : options.scenes) {
    for (const std::optional<float> value : values_to_time(options)) {
      const Stage stage(engine, scene, sweep_of(scene, value), options.stage());
      for (const std::string& movement : options.movements) {
        for (const auto& [row, settings] : options.rows()) {
          Shot shot = options.shot(movement);
          shot.frames += warm_up;
          Timing timing = summarise(stage.time(settings, shot), warm_up);
          timing.scene = scene;
          timing.value = value;
          timing.technique = row;
          timing.movement = shot.movement;
          std::fprintf(stderr, "%s %s %s: %.1f frames per second\n", scene.c_str(),
                       movement.c_str(), row.c_str(), timing.mean_fps);
          timings.push_back(std::move(timing));
        }
      }
    }
  }
  std::fputs(timing_tables(timings).c_str(), stdout);
  return timings;
}

/// The similarity of every frame of a static view, from its first.
std::vector<Moment> measure_over_time(render::Engine& engine, const Options& options) {
  std::vector<Moment> moments;
  for (const std::string& scene : options.scenes) {
    for (const std::optional<float> value : values_to_time(options)) {
      const Stage stage(engine, scene, sweep_of(scene, value), options.stage());
      Shot shot = options.shot("static");
      const std::string taken =
          scene + "_" + (value ? std::to_string(int(100.0f * *value)) : "own");
      const render::Frame truth = options.truth(stage, taken + "_static_", shot).back();
      shot.compared = shot.frames;
      for (const auto& [row, settings] : options.rows()) {
        const Played played = stage.play(settings, shot);
        for (std::size_t i = 0; i < played.frames.size(); ++i) {
          moments.push_back({scene, row, value, int(i) + 1, test::ssim(played.frames[i], truth)});
        }
        std::fprintf(stderr, "%s %s: ssim %.4f after %d frames\n", scene.c_str(), row.c_str(),
                     moments.back().ssim, shot.frames);
      }
    }
  }
  return moments;
}

nlohmann::json description(const render::Engine& engine, const Options& options) {
  nlohmann::json rows = nlohmann::json::object();
  for (const auto& [name, settings] : options.rows()) rows[name] = protocol::to_json(settings);
  return {{"device", engine.device().name},
          {"tracer", protocol::enum_name(engine.tracer())},
          {"size", options.size},
          {"frames", options.frames},
          {"frame_rate", options.frame_rate},
          {"samples", options.samples},
          {"texture_size", options.texture_size},
          {"draw_scale", options.draw_scale},
          {"truth", options.ground_truth},
          {"seeds", options.seeds},
          {"settings", rows}};
}

void run(const Options& options) {
  if (!options.output.empty()) {
    std::filesystem::create_directories(options.output);
    // save_image() writes to this folder.
    setenv("HELIOGRAPH_TEST_OUTPUT", options.output.c_str(), 1);
  }
  render::Engine engine({.device = options.device, .tracer = options.tracer});
  std::printf("%s, %s, %s pixels, %d frames at %g per second, ground truth of %d samples\n",
              engine.device().name.c_str(),
              std::string(protocol::enum_name(engine.tracer())).c_str(), options.size.c_str(),
              options.frames, double(options.frame_rate), options.samples);
  Results results;
  if (!options.without_quality) results.measurements = measure_quality(engine, options);
  if (!options.without_timings) results.timings = measure_times(engine, options);
  if (options.over_time) results.moments = measure_over_time(engine, options);
  if (!options.output.empty()) {
    write_files(options.output, results, description(engine, options));
  }
}

}  // namespace
}  // namespace heliograph::paper

int main(int count, char** arguments) {
  using namespace heliograph;
  paper::Options options;
  for (const scenes::PaperScene& scene : scenes::paper_scenes()) {
    options.scenes.emplace_back(scene.name);
  }
  for (const paper::Technique& technique : paper::techniques()) {
    options.presets.push_back(technique.name);
  }
  CLI::App app("Regenerates the paper's figures: SSIM over roughness and shadow angle, frame rates",
               "heliograph-experiments");
  paper::add_options(app, options);
  CLI11_PARSE(app, count, arguments);
  try {
    paper::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heliograph-experiments: %s\n", error.what());
    return 1;
  }
  return 0;
}
