#include "tests/paper/options.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "protocol/settings/settings_json.hpp"

namespace heliograph::paper {
namespace {

/// Frames of one size as they are in memory, one after the other.
void write_frames(const std::filesystem::path& path, const std::vector<render::Frame>& frames) {
  std::filesystem::create_directories(path.parent_path());
  const std::filesystem::path unfinished = path.string() + ".part";
  std::ofstream file(unfinished, std::ios::binary);
  for (const render::Frame& frame : frames) {
    file.write(reinterpret_cast<const char*>(frame.rgba.data()),
               static_cast<std::streamsize>(frame.rgba.size()));
  }
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
  std::filesystem::rename(unfinished, path);
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

void assign(protocol::Settings& all, const std::string& assignment) {
  const auto accepted = protocol::set_by_path(all, assignment);
  if (!accepted) throw std::invalid_argument(accepted.error().message);
}

/// The settings of a file like those in scenes/presets: on top of the preset that it extends.
protocol::Settings read_preset(const std::string& path, Paths paths) {
  std::ifstream file(path);
  nlohmann::json own = nlohmann::json::parse(file, nullptr, false);
  if (!own.is_object()) throw std::invalid_argument(path + " is no JSON object");
  protocol::Settings all = find_technique(own.value("extends", "best")).settings(paths);
  own.erase("extends");
  const auto applied = protocol::apply_patch(all, own);
  if (!applied) {
    throw std::invalid_argument(path + ": " + applied.error().message);
  }
  return all;
}

}  // namespace

StageOptions Options::stage() const {
  StageOptions stage{.texture_size = texture_size, .draw_scale = draw_scale};
  char end = 0;
  if (std::sscanf(size.c_str(), "%ux%u%c", &stage.width, &stage.height, &end) != 2) {
    throw std::invalid_argument("--size " + size + " must look like 640x360");
  }
  return stage;
}

std::vector<Row> Options::rows() const {
  const Paths paths = ground_truth == "full" ? Paths::all : Paths::of_paper;
  const auto with_settings = [&](protocol::Settings all) {
    for (const std::string& assignment : settings) assign(all, assignment);
    return all;
  };
  const auto of = [&](const std::string& preset) {
    return with_settings(find_technique(preset).settings(paths));
  };
  std::vector<Row> all;
  if (preset_file.empty()) {
    for (const std::string& preset : presets) all.emplace_back(preset, of(preset));
  } else {
    const std::string stem = std::filesystem::path(preset_file).stem().string();
    all.emplace_back(stem, with_settings(read_preset(preset_file, paths)));
    all.emplace_back(against, of(against));
  }
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

std::vector<render::Frame> Options::truth(const Stage& stage, const std::string& name,
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

Shot Options::shot(const std::string& movement) const {
  return {
      .movement = parse_movement(movement), .frames = frames, .frame_seconds = 1.0f / frame_rate};
}

std::vector<float> Options::values_for(Swept swept) const {
  if (!values.empty()) return values;
  const auto all = paper_values(swept);
  return {all.begin(), all.end()};
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--scenes", options.scenes, "Scenes of the paper [all eight]")->delimiter(',');
  app.add_option("--presets", options.presets,
                 "Rows: svgf, rectification, adapted, separable, reinhard, best, fast_history, "
                 "percentile, gradient [all]")
      ->delimiter(',');
  app.add_option(
         "--preset", options.preset_file,
         "A file like those in scenes/presets, measured beside --against in place of --presets")
      ->check(CLI::ExistingFile);
  app.add_option("--against", options.against, "The preset that --preset is compared with")
      ->capture_default_str();
  app.add_option("--seeds", options.seeds, "Seeds of random sequences: each is measured")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--movements", options.movements, "Of static, moving_camera, moving_objects_light")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--values", options.values,
                 "Swept values [the paper's; for times the scene's own]")
      ->delimiter(',');
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
  app.add_flag("--over-time", options.over_time,
               "Also the SSIM of every frame of a static view from its first");
}

}  // namespace heliograph::paper
