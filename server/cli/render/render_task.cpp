#include "cli/render/render_task.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "cli/engine_options.hpp"
#include "cli/render/manifest.hpp"
#include "cli/render/render_edits.hpp"
#include "protocol/limits.hpp"
#include "protocol/settings/presets.hpp"
#include "protocol/settings/settings_json.hpp"
#include "render/api/buffer_names.hpp"

namespace heliograph::cli {
namespace {

using protocol::FileFormat;

std::optional<FileFormat> named_format(const std::string& name) {
  return name == "jpg" ? FileFormat::jpeg : protocol::enum_value<FileFormat>(name);
}

FileFormat format_of(const protocol::RenderRequest& request, const OutputName& output) {
  if (request.format) return *request.format;
  if (output.is_standard_output()) return FileFormat::png;
  const std::string extension = output.extension();
  const std::string name = extension.substr(std::min<std::size_t>(extension.size(), 1));
  const auto format = named_format(name);
  if (format && *format != FileFormat::animated_webp) return *format;
  throw std::invalid_argument(
      "--output: must be a .png, .jpg, .webp, .exr, .npy, .mp4 or .webm file, not " +
      request.output);
}

protocol::Settings with_patch(protocol::Settings settings, const protocol::RawJson& patch,
                              const std::string& what) {
  const auto applied = protocol::apply_patch(settings, patch.value());
  if (!applied) throw std::invalid_argument(what + ": " + applied.error().message);
  return settings;
}

/// Those of the command line, then the entry's.
protocol::Settings settings_of(const protocol::RenderRequest& request,
                               protocol::Settings settings) {
  if (!request.preset.empty()) {
    const auto preset = protocol::find_preset(request.preset);
    if (!preset) {
      throw std::invalid_argument("preset " + request.preset + ": " + preset.error().message);
    }
    settings = with_patch(settings, preset->settings, "preset");
  }
  if (request.edits && request.edits->environment) {
    settings.environment.rotation = request.edits->environment->rotation;
    settings.environment.intensity = request.edits->environment->intensity;
  }
  if (request.settings) settings = with_patch(settings, *request.settings, "settings");
  if (request.reference) {
    settings.reference.use = protocol::ReferenceUse::always;
    settings.reference.scope = *request.reference;
  }
  // An image is complete with the samples that were asked for.
  if (settings.reference.use == protocol::ReferenceUse::automatic) {
    settings.reference.use = protocol::ReferenceUse::off;
  }
  const bool ends_otherwise = request.quality || request.time_limit;
  if (request.samples || ends_otherwise) {
    const std::uint32_t samples = request.samples.value_or(protocol::max_samples_per_pixel);
    settings.accumulation.max_samples = static_cast<int>(samples);
  }
  return settings;
}

bool has_many_frames(const protocol::RenderRequest& request) {
  return request.turntable || request.path ||
         (!request.clip.empty() && request.frames.value_or(1) > 1);
}

/// The name of an entry's files, which tells its images apart.
OutputName output_of(const protocol::RenderRequest& request, FileFormat format, OutputName output) {
  const bool one_file = holds_frames(format);
  const bool frames = has_many_frames(request) && !one_file;
  const bool cameras = request.camera == "all";
  if (output.is_standard_output()) {
    if (frames || cameras || one_file) {
      throw std::invalid_argument("--output: standard output takes one image only");
    }
    return output;
  }
  if (cameras && !output.has_camera()) {
    throw std::invalid_argument(
        "--output: --camera all needs {camera} in the name, such as {scene}_{camera}.png");
  }
  if (one_file && output.has_frame()) {
    throw std::invalid_argument("--output: one file holds all frames: {frame} has no value");
  }
  if (frames && !output.has_frame()) output.add_frame();
  return output;
}

void check_folder(const std::filesystem::path& folder) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("--output: cannot write into " + folder.string() + ": " + why);
  };
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) refuse("there is no such folder");
  if (access(folder.c_str(), W_OK | X_OK) != 0) refuse(std::strerror(errno));
}

/// "30,-10"
std::array<float, 2> parse_orbit(const std::string& text) {
  std::array<float, 2> angles{};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, angles[0]);
  const bool split = first.ec == std::errc() && first.ptr != end && *first.ptr == ',';
  const auto second = split ? std::from_chars(first.ptr + 1, end, angles[1]) : first;
  const bool valid = split && second.ec == std::errc() && second.ptr == end &&
                     std::abs(angles[0]) <= 360.0f && std::abs(angles[1]) <= 90.0f;
  if (!valid) {
    throw std::invalid_argument("--orbit " + text +
                                ": must be AZIMUTH,ELEVATION in degrees, such as 30,20");
  }
  return angles;
}

void check_path(const protocol::RenderRequest& request) {
  if (request.frames || request.turntable) {
    throw std::invalid_argument(std::string(request.frames ? "--frames" : "--turntable") +
                                ": --path has a number of frames of its own");
  }
  if (request.view || request.orbit || request.fit || !request.camera.empty()) {
    throw std::invalid_argument(
        "--path: is a camera of its own; --camera, --orbit, --fit and "
        "view are others");
  }
  for (const protocol::RenderView& key : request.path->keys) {
    if (key.eye == key.target) throw std::invalid_argument("--path: eye and target coincide");
  }
}

void check_combination(const protocol::RenderRequest& request, bool timings) {
  if (request.frames && request.clip.empty() && !request.path && !timings) {
    throw std::invalid_argument("--frames: needs --clip, or --timings; --turntable has its own");
  }
  if (request.frames && request.turntable) {
    throw std::invalid_argument("--frames: --turntable has a number of frames of its own");
  }
  if (request.path) check_path(request);
  if (request.view && !request.camera.empty()) {
    throw std::invalid_argument("view: camera names another one");
  }
  if (request.orbit && (request.view || !request.camera.empty())) {
    throw std::invalid_argument("--orbit: is a camera of its own; --camera and view are others");
  }
  if (request.quality && request.buffer != "output") {
    throw std::invalid_argument("--quality: is that of the output, not of " + request.buffer);
  }
  const auto named = render::check_buffer_name(request.buffer, "--buffer " + request.buffer);
  if (!named) throw std::invalid_argument(named.error().message);
}

Background background_of(const protocol::RenderRequest& request, FileFormat format) {
  const Background background(request.background);
  if (background.is_rendered()) return background;
  if (request.buffer != "output") {
    throw std::invalid_argument("--background: the buffer " + request.buffer + " has its own");
  }
  if (format == FileFormat::exr || format == FileFormat::npy) {
    throw std::invalid_argument("--background: values have none; the alternative is a .png");
  }
  const bool keeps_alpha = format == FileFormat::png || format == FileFormat::webp ||
                           format == FileFormat::animated_webp;
  if (background.is_transparent() && !keeps_alpha) {
    throw std::invalid_argument("--background: only .png and .webp files can be transparent");
  }
  return background;
}

RenderTask make_task(const protocol::RenderRequest& request, std::size_t number, bool timings,
                     const protocol::Settings& settings) {
  if (request.output.empty()) throw std::invalid_argument("--output: is required");
  check_combination(request, timings);
  const OutputName name(request.output);
  const FileFormat format = format_of(request, name);
  RenderTask task{.number = number,
                  .request = request,
                  .output = output_of(request, format, name),
                  .format = format,
                  .settings = settings_of(request, settings),
                  .background = background_of(request, format)};
  if (!name.is_standard_output()) check_folder(task.output.folder());
  if (task.background.is_blurred()) {
    task.settings.background.show = protocol::BackgroundKind::blurred;
  }
  if (!task.background.is_rendered()) task.settings.environment.visible = false;
  return task;
}

/// What the command line says about every entry.
protocol::RenderRequest common_request(const RenderOptions& options) {
  protocol::RenderRequest request = options.request;
  if (!options.format.empty()) request.format = named_format(options.format);
  if (!options.reference.empty()) {
    request.reference = protocol::enum_value<protocol::ReferenceScope>(options.reference);
  }
  if (!options.edits.empty()) request.edits = read_edits(options.edits);
  if (!options.path.empty()) request.path = read_path(options.path);
  if (!options.orbit.empty()) request.orbit = parse_orbit(options.orbit);
  // With --timings these are the frames to measure.
  if (options.timings) request.frames.reset();
  return request;
}

std::vector<protocol::RenderRequest> requests_of(const RenderOptions& options) {
  const protocol::RenderRequest common = common_request(options);
  if (!options.manifest.empty()) return read_manifest(options.manifest, common);
  std::vector<protocol::RenderRequest> requests;
  for (const std::filesystem::path& scene : options.scenes) {
    requests.push_back(common);
    requests.back().scene = scene.string();
  }
  return requests;
}

void check_set(const RenderOptions& options) {
  if (options.scenes.empty() && options.manifest.empty()) {
    throw std::invalid_argument("a scene is missing, or --manifest");
  }
  const OutputName output(options.request.output.empty() ? "-" : options.request.output);
  if (options.request.output != "-" && options.scenes.size() > 1 && !output.has_scene()) {
    throw std::invalid_argument(
        "--output: several scenes need {scene} in the name, such as {scene}.png");
  }
  if (!output.is_standard_output() || options.request.output.empty()) return;
  if (options.timings) throw std::invalid_argument("--timings prints to standard output, too");
  if (options.scenes.size() != 1) {
    throw std::invalid_argument("--output: standard output takes one image only");
  }
}

/// The share of the whole that a process renders: entries `first`, `first + step` ... from 0 on.
struct Shard {
  std::size_t first = 0;
  std::size_t step = 1;
};

/// "2/4"; empty: everything.
Shard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  std::size_t number = 0, count = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, number);
  const bool split = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = split ? std::from_chars(first.ptr + 1, end, count) : first;
  if (!split || second.ec != std::errc() || second.ptr != end || number < 1 || number > count) {
    throw std::invalid_argument("--shard " + text + ": must be I/N, 1/N to N/N");
  }
  return {.first = number - 1, .step = count};
}

}  // namespace

bool holds_frames(FileFormat format) {
  return format == FileFormat::mp4 || format == FileFormat::webm ||
         format == FileFormat::animated_webp;
}

std::vector<RenderTask> make_tasks(const RenderOptions& options) {
  check_set(options);
  const Shard shard = parse_shard(options.shard);
  const protocol::Settings settings = parse_settings(options.settings);
  const std::vector<protocol::RenderRequest> requests = requests_of(options);
  std::vector<RenderTask> tasks;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    try {
      // Every process refuses what is wrong in any entry.
      RenderTask task = make_task(requests[i], i + 1, options.timings, settings);
      if (i % shard.step == shard.first) tasks.push_back(std::move(task));
    } catch (const std::exception& failure) {
      if (options.manifest.empty()) throw;
      throw std::invalid_argument(options.manifest + ": entry " + std::to_string(i + 1) + ": " +
                                  failure.what());
    }
  }
  return tasks;
}

}  // namespace heliograph::cli
