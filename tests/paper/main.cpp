// Regenerates the figures and tables of section 4 of Granja and Pereira, "Hybrid-Rendering
// Techniques in GPU" (2021): SSIM over roughness and shadow angle, and frame rates.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenes/generator/scenes/paper_scenes.hpp"
#include "tests/paper/report.hpp"
#include "tests/paper/stage.hpp"
#include "tests/support/image_comparison.hpp"

namespace heliograph::paper {
namespace {

/// Frames of one size as they are in memory, one after the other.
void write_frames(const std::filesystem::path& path, const std::vector<render::Frame>& frames) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  for (const render::Frame& frame : frames) {
    file.write(reinterpret_cast<const char*>(frame.rgba.data()),
               static_cast<std::streamsize>(frame.rgba.size()));
  }
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

std::vector<render::Frame> read_frames(const std::filesystem::path& path,
                                       const StageOptions& stage) {
  std::ifstream file(path, std::ios::binary);
  std::vector<render::Frame> frames;
  const std::size_t bytes = std::size_t{stage.width} * stage.height * 4;
  const std::size_t count = std::filesystem::file_size(path) / bytes;
  for (std::size_t i = 0; i < count; ++i) {
    render::Frame& frame = frames.emplace_back();
    frame.width = stage.width;
    frame.height = stage.height;
    frame.rgba.resize(bytes);
    file.read(reinterpret_cast<char*>(frame.rgba.data()), static_cast<std::streamsize>(bytes));
  }
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return frames;
}

struct Options {
  std::vector<std::string> scenes;
  std::vector<std::string> presets;
  std::vector<std::string> movements{"static", "moving_camera", "moving_objects_light"};
  std::vector<float> values;
  std::vector<std::string> settings;  // path=value, on top of every preset
  std::vector<std::string> variants;  // name:path=value,path=value, on top of those of `best`
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

  StageOptions stage() const {
    StageOptions stage{.texture_size = texture_size, .draw_scale = draw_scale};
    char end = 0;
    if (std::sscanf(size.c_str(), "%ux%u%c", &stage.width, &stage.height, &end) != 2) {
      throw std::invalid_argument("--size " + size + " must look like 640x360");
    }
    return stage;
  }
  protocol::Settings of(const std::string& preset) const {
    protocol::Settings all =
        find_technique(preset).settings(ground_truth == "full" ? Paths::all : Paths::of_paper);
    for (const std::string& assignment : settings) assign(all, assignment);
    return all;
  }
  /// The presets and the variants, by name.
  std::vector<std::pair<std::string, protocol::Settings>> rows() const {
    std::vector<std::pair<std::string, protocol::Settings>> all;
    for (const std::string& preset : presets) all.emplace_back(preset, of(preset));
    for (const std::string& variant : variants) {
      const std::size_t colon = variant.find(':');
      if (colon == std::string::npos) {
        throw std::invalid_argument("--variant " + variant + " must look like NAME:PATH=VALUE");
      }
      protocol::Settings changed = of("best");
      std::istringstream assignments(variant.substr(colon + 1));
      for (std::string one; std::getline(assignments, one, ',');) assign(changed, one);
      all.emplace_back(variant.substr(0, colon), changed);
    }
    return all;
  }
  /// Ground truth of a shot, from the folder of those that earlier runs have left.
  std::vector<render::Frame> truth(const Stage& stage, const std::string& name,
                                   const Shot& shot) const {
    const GroundTruth source = ground_truth == "reference" ? GroundTruth::reference
                               : ground_truth == "full"    ? GroundTruth::full
                                                           : GroundTruth::accumulated;
    if (ground_truth_folder.empty()) return stage.ground_truth(source, shot, samples);
    std::ostringstream file;
    file << name << size << '_' << frames << '_' << frame_rate << '_' << samples << '_'
         << texture_size << '_' << ground_truth << ".rgba";
    const auto path = std::filesystem::path(ground_truth_folder) / file.str();
    if (std::filesystem::exists(path)) return read_frames(path, this->stage());
    auto made = stage.ground_truth(source, shot, samples);
    write_frames(path, made);
    return made;
  }
  static void assign(protocol::Settings& all, const std::string& assignment) {
    const auto accepted = protocol::set_by_path(all, assignment);
    if (!accepted) throw std::invalid_argument(accepted.error().message);
  }
  Shot shot(const std::string& movement) const {
    return {
        .movement = parse_movement(movement), .frames = frames, .frame_seconds = 1.0f / frame_rate};
  }
};

std::vector<float> values_for(const Options& options, Swept swept) {
  if (!options.values.empty()) return options.values;
  const auto all = paper_values(swept);
  return {all.begin(), all.end()};
}

void measure_quality(render::Engine& engine, const Options& options,
                     std::vector<Measurement>& measurements) {
  for (const std::string& scene : options.scenes) {
    const Swept swept = swept_in(scene);
    const std::size_t first = measurements.size();
    for (const float value : values_for(options, swept)) {
      const Stage stage(engine, scene, sweep_to(swept, value), options.stage());
      for (const std::string& movement : options.movements) {
        const Shot shot = options.shot(movement);
        const std::string taken =
            scene + "_" + std::to_string(int(100.0f * value)) + "_" + movement + "_";
        const auto ground_truth = options.truth(stage, taken, shot);
        test::save_image(taken + "ground_truth", ground_truth.back());
        for (const auto& [row, settings] : options.rows()) {
          const Played played = stage.play(settings, shot);
          test::save_image(taken + row, played.frames.back());
          const Quality quality = compare(played.frames, ground_truth);
          measurements.push_back({scene, swept, value, shot.movement, row, quality});
          std::fprintf(stderr, "%s %g %s %s: ssim %.4f flicker %.2f luminance %.3f rays %.3f\n",
                       scene.c_str(), double(value), movement.c_str(), row.c_str(), quality.ssim,
                       quality.flicker, quality.luminance_ratio, played.rays_per_pixel);
        }
      }
    }
    const std::vector<Measurement> of_scene(measurements.begin() + std::ptrdiff_t(first),
                                            measurements.end());
    std::fputs(quality_tables(of_scene).c_str(), stdout);
    std::fflush(stdout);
  }
}

std::vector<Timing> measure_times(render::Engine& engine, const Options& options) {
  constexpr int warm_up = 5;
  std::vector<Timing> timings;
  for (const std::string& scene : options.scenes) {
    const Stage stage(engine, scene, {}, options.stage());
    for (const std::string& movement : options.movements) {
      for (const std::string& preset : options.presets) {
        Shot shot = options.shot(movement);
        shot.frames += warm_up;
        Timing timing = summarise(stage.time(options.of(preset), shot), warm_up);
        timing.scene = scene;
        timing.technique = preset;
        timing.movement = shot.movement;
        timings.push_back(std::move(timing));
      }
    }
  }
  std::fputs(timing_tables(timings).c_str(), stdout);
  return timings;
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
  std::vector<Measurement> measurements;
  std::vector<Timing> timings;
  if (!options.without_quality) measure_quality(engine, options, measurements);
  if (!options.without_timings) timings = measure_times(engine, options);
  if (!options.output.empty()) {
    write_files(options.output, measurements, timings, engine.device().name);
  }
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--scenes", options.scenes, "Scenes of the paper [all eight]")->delimiter(',');
  app.add_option("--presets", options.presets,
                 "Rows: svgf, rectification, adapted, separable, reinhard, best, fast_history, "
                 "percentile, gradient [all]")
      ->delimiter(',');
  app.add_option("--movements", options.movements, "Of static, moving_camera, moving_objects_light")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--values", options.values, "Swept values [the paper's]")->delimiter(',');
  app.add_option("--set", options.settings, "A setting on top of every preset")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("--variant", options.variants,
                 "A further row: the preset best with these settings on top")
      ->type_name("NAME:PATH=VALUE,PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("--size", options.size, "Frame size")->capture_default_str();
  app.add_option("--frames", options.frames, "Frames of each run")
      ->check(CLI::Range(3, 100000))
      ->capture_default_str();
  app.add_option("--frame-rate", options.frame_rate, "Frames per second of clip time")
      ->check(CLI::Range(1.0f, 1000.0f))
      ->capture_default_str();
  app.add_option("--samples", options.samples, "Samples per pixel of ground truth")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  app.add_option("--texture-size", options.texture_size, "Width of the scenes' textures")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--draw-scale", options.draw_scale,
                 "Fraction of width and height that frames are drawn at and reconstructed from")
      ->check(CLI::Range(0.1f, 1.0f));
  app.add_option("--truth", options.ground_truth,
                 "The path tracer along the hybrid's light paths, the same with global "
                 "illumination, or the hybrid's own samples averaged")
      ->check(CLI::IsMember({"reference", "full", "accumulated"}))
      ->capture_default_str();
  app.add_option("--ground-truth-folder", options.ground_truth_folder,
                 "Folder that keeps ground truth from run to run: rendered once for each case");
  app.add_option("--output", options.output,
                 "Folder for CSV, JSON and the last frame of every run");
  app.add_option("--device", options.device, "Part of the Vulkan device's name");
  app.add_option("--tracer", options.tracer, "Ray tracer")->capture_default_str();
  app.add_flag("--without-quality", options.without_quality, "Only frame rates");
  app.add_flag("--without-timings", options.without_timings, "Only quality");
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
